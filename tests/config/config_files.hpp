#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "fleetmap/config/fleet_file.hpp"
#include "fleetmap/config/override.hpp"
#include "fleetmap/config/robot_file.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::config {

/// Writes a file, loads it and returns the error.
class ConfigFiles : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) {
    const std::filesystem::path file = folder_.path() / "config.yaml";
    std::ofstream(file, std::ios::trunc) << text;
    return file;
  }
  std::string robot_error_of(const std::filesystem::path& file, const std::vector<Override>& overrides = {}) {
    const auto robot = load_robot(file, overrides);
    return robot ? "no error" : robot.error().message;
  }
  std::string robot_error(const std::string& text, const std::vector<Override>& overrides = {}) {
    return robot_error_of(write(text), overrides);
  }
  std::string fleet_error(const std::string& text, const std::vector<Override>& overrides = {}) {
    const auto fleet = load_fleet(write(text), overrides);
    return fleet ? "no error" : fleet.error().message;
  }

  testing::TemporaryFolder folder_;
};

/// The least that a robot's file needs.
inline const std::string kRobot = "id: r1\nfleet: [r1, r2]\ndirectory: out\n";

}  // namespace fleetmap::config
