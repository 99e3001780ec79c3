#pragma once

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "fleetmap/sensor/frame_tree.hpp"
#include "spoilt_recordings.hpp"
#include "support/generated_fleet.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::testing {

/// The LiDAR's mount in a generated recording.
inline const std::vector<std::string> kGeneratedMount{"--set", "lidar.translation=[0,0,0.8]"};

/// Tests of what the program makes of one good recording of 28 s, or of changed ones.
class GeneratedDrive : public ::testing::Test {
 protected:
  struct Outcome {
    int exit_code = 0;
    std::string output;
    double shape = 0.0;  ///< m, RMS after alignment; infinite where fewer than half of the scans have a pose
    double place = 0.0;  ///< m, RMS as it is; likewise
  };

  static void SetUpTestSuite();
  static void TearDownTestSuite();

  static void read_recording(const std::filesystem::path& bag, Recording& recording);
  /// The bag's folder.
  static std::filesystem::path write(const std::string& name, const Recording& recording,
                                     const std::vector<sensor::FrameTransform>& frames = {});
  static Outcome odometry(const std::string& name, const Recording& recording,
                          const std::vector<std::string>& settings = kGeneratedMount,
                          const std::vector<sensor::FrameTransform>& frames = {});
  static Outcome run(const std::string& name, const Recording& recording,
                     const std::vector<std::string>& settings = kGeneratedMount);

  static inline std::unique_ptr<TemporaryFolder> folder_;
  static inline GeneratedFleet fleet_;
  static inline Recording good_;
};

}  // namespace fleetmap::testing
