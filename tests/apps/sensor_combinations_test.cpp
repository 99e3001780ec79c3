// One drive with each combination of sensors that robots have, and how accurate its map's trajectory is.
#include <gmock/gmock.h>

#include <functional>
#include <iomanip>
#include <iostream>
#include <random>

#include "fleetmap/geometry/geodesy.hpp"
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
};

// GPS of the drive is off by up to 3.4 m, slowly, so that every place is within that; its sigma is 1.5 m an
// axis.
constexpr double kSlowGps = 4.0, kNoGps = 1e9;
constexpr double kShape = 0.03;

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

using SensorCombinations = testing::GeneratedDrive;

/// Fixes with white errors of 2 cm, 3 cm in height.
std::function<void(Recording&)> rtk(const testing::GeneratedFleet& fleet) {
  return [&fleet](Recording& recording) {
    const LocalFrame site(fleet.origin);
    const testing::GeneratedRobot& robot = fleet.robots[0];
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    const Eigen::Vector3d sigma(0.02, 0.02, 0.03);
    std::erase_if(recording, [&](const Recorded& one) {  // before the first scan and after the last
      const auto* fix = std::get_if<sensor::Fix>(&one.sample);
      return fix != nullptr && (fix->stamp < robot.stamps.front() || fix->stamp > robot.stamps.back());
    });
    each<sensor::Fix>([&](sensor::Fix& fix) {
      const auto at = std::ranges::lower_bound(robot.stamps, fix.stamp) - robot.stamps.begin();
      const Eigen::Vector3d noise(normal(random), normal(random), normal(random));
      fix.position = site.to_geo(robot.T_enu_base[static_cast<std::size_t>(at)].translation() +
                                 sigma.cwiseProduct(noise));
      fix.covariance = sigma.cwiseAbs2().asDiagonal();
    })(recording);
  };
}

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
      {"RTK of 2 cm", rtk(fleet_), kShape, 0.05},
  };
  for (const Combination& combination : all) {
    SCOPED_TRACE(combination.name);
    Recording recording = good_;
    combination.change(recording);
    const Outcome outcome = run(combination.name, recording);
    std::cout << std::left << std::setw(26) << combination.name << std::fixed << std::setprecision(3)
              << "shape " << outcome.shape << " m, place " << outcome.place << " m\n";
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    EXPECT_LT(outcome.shape, combination.max_shape);
    EXPECT_LT(outcome.place, combination.max_place);
  }
}

}  // namespace
}  // namespace fleetmap
