// One drive with each combination of sensors that robots have, and how accurate its map's trajectory is.
#include <gmock/gmock.h>

#include <functional>
#include <iomanip>
#include <iostream>

#include "generated_drive.hpp"

namespace fleetmap {
namespace {

using testing::each;
using testing::Recorded;
using testing::Recording;

struct Combination {
  std::string name;
  std::function<void(Recording&)> change;
  double max_shape;  ///< m
  double max_place;  ///< m
  std::vector<std::string> settings = testing::kGeneratedMount;
};

// GPS of the drive is off by up to 3.4 m, slowly, so that every place is within that; its sigma is 1.5 m an
// axis.
constexpr double kSlowGps = 4.0;
constexpr double kNoGps = 0.1;  // it begins at the site's origin
constexpr double kShape = 0.006;

template <class T>
void without(Recording& recording) {
  std::erase_if(recording, [](const Recorded& one) { return std::holds_alternative<T>(one.sample); });
}

void without_orientation(Recording& recording) {
  each<sensor::Imu>([](sensor::Imu& imu) { imu.q_enu_imu.reset(); })(recording);
}

void gps_of_1_hz(Recording& recording) {
  std::size_t number = 0;
  std::erase_if(recording, [&](const Recorded& one) {
    return std::holds_alternative<sensor::Fix>(one.sample) && number++ % 5 != 0;
  });
}

/// A second wheel odometry, which is wrong: it must be of no effect where the first is named.
void with_other_wheels(Recording& recording) {
  Recording both;
  for (const Recorded& one : recording) {
    both.push_back(one);
    const auto* wheel = std::get_if<sensor::Wheel>(&one.sample);
    if (wheel == nullptr) continue;
    sensor::Wheel other = *wheel;
    other.forward_speed *= 1.5;
    both.push_back({other, one.received, {}, "rt/odom"});
  }
  recording = std::move(both);
}

std::vector<std::string> with_settings(std::vector<std::string> settings) {
  settings.insert(settings.end(), testing::kGeneratedMount.begin(), testing::kGeneratedMount.end());
  return settings;
}

using SensorCombinations = testing::GeneratedDrive;

TEST_F(SensorCombinations, EachHasItsAccuracy) {
  const std::vector<Combination> all{
      {"all", [](Recording&) {}, kShape, kSlowGps},
      {"IMU without orientation", without_orientation, kShape, kSlowGps},
      {"no wheels", without<sensor::Wheel>, kShape, kSlowGps},
      {"no IMU", without<sensor::Imu>, kShape, kSlowGps},
      {"LiDAR and GPS",
       [](Recording& recording) {
         without<sensor::Wheel>(recording);
         without<sensor::Imu>(recording);
       },
       kShape, kSlowGps},
      {"no GPS", without<sensor::Fix>, kShape, kNoGps},
      {"LiDAR alone",
       [](Recording& recording) {
         without<sensor::Wheel>(recording);
         without<sensor::Imu>(recording);
         without<sensor::Fix>(recording);
       },
       kShape, kNoGps},
      {"GPS of 1 Hz", gps_of_1_hz, kShape, kSlowGps},
      {"two wheel odometries", with_other_wheels, kShape, kSlowGps,
       with_settings({"--set", "recording.topics.wheel=/wheel_odometry"})},
  };
  for (const Combination& combination : all) {
    SCOPED_TRACE(combination.name);
    Recording recording = good_;
    combination.change(recording);
    const Outcome outcome = run(combination.name, recording, combination.settings);
    std::cout << std::left << std::setw(26) << combination.name << std::fixed << std::setprecision(3)
              << "shape " << outcome.shape << " m, place " << outcome.place << " m\n";
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    EXPECT_LT(outcome.shape, combination.max_shape);
    EXPECT_LT(outcome.place, combination.max_place);
  }
}

}  // namespace
}  // namespace fleetmap
