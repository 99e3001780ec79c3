// Whole calibrations of generated recordings, by the program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "support/command_line.hpp"
#include "support/generated_fleet.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap {
namespace {

using ::testing::HasSubstr;

class RecordingCalibration : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<testing::TemporaryFolder>();
    ASSERT_TRUE(testing::write_generated_fleet(folder_->path(), {"r2"}));
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static nlohmann::json calibrate(const std::vector<std::string>& settings) {
    std::vector<std::string> command{testing::kProgram, "calibrate", (folder_->path() / "r1").string(),
                                     "--json",          "--log",     "off"};
    for (const std::string& setting : settings) {
      command.emplace_back("--set");
      command.push_back(setting);
    }
    testing::Process process(command);
    EXPECT_EQ(process.wait(), 0) << process.output();
    return nlohmann::json::parse(process.output());
  }

  static nlohmann::json quantity(const nlohmann::json& calibration, const std::string& sensor,
                                 const std::string& name) {
    for (const auto& one : calibration["quantities"]) {
      if (one["sensor"] == sensor && one["quantity"] == name) return one;
    }
    return {};
  }

  static inline std::unique_ptr<testing::TemporaryFolder> folder_;
};

/// The LiDAR is at [0, 0, 0.8] and drives along base_link's x axis.
TEST_F(RecordingCalibration, FindsATurnedLidarByTheWheels) {
  const auto calibration = calibrate({"lidar.translation=[0,0,0.8]", "lidar.rotation_rpy_deg=[0,0,4]"});
  const auto yaw = quantity(calibration, "LiDAR", "turn about z against its mount in use");
  ASSERT_TRUE(yaw["observable"].get<bool>()) << yaw;
  EXPECT_TRUE(yaw["differs"].get<bool>());
  EXPECT_LT(yaw["sigma"].get<double>(), 0.1);
  EXPECT_NEAR(yaw["value"].get<double>(), -4.0, 4.0 * yaw["sigma"].get<double>());
  EXPECT_FALSE(quantity(calibration, "LiDAR", "z")["observable"].get<bool>());
}

TEST_F(RecordingCalibration, SaysWhatTheDriveDoesNotShow) {
  testing::Process process({testing::kProgram, "calibrate", (folder_->path() / "r2").string(), "--set",
                            "lidar.translation=[0,0,0.8]"});
  EXPECT_EQ(process.wait(), 0) << process.output();
  EXPECT_THAT(process.output(), HasSubstr("GPS antenna: not observable on this drive, no fixes"));
  EXPECT_THAT(process.output(), HasSubstr("lidar:\n"));
}

TEST_F(RecordingCalibration, RefusesARecordingThatIsNone) {
  testing::Process process({testing::kProgram, "calibrate", (folder_->path() / "none").string()});
  EXPECT_EQ(process.wait(), 1);
  EXPECT_THAT(process.output(), HasSubstr("none"));
}

}  // namespace
}  // namespace fleetmap
