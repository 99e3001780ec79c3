// The odometry, LiDAR alone, under what robots meet: speed, turns, a shaking mast, few rays, noise and rates.
// Bounds: docs/reference/test_bounds.md. tests/bench/odometry_conditions.cpp has longer drives of more
// conditions.
#include <gtest/gtest.h>

#include "fleetmap/geometry/degree.hpp"
#include "fleetmap/sim/solar_farm.hpp"
#include "sim/lane_odometry.hpp"
#include "support/measured.hpp"

namespace fleetmap::testing {
namespace {

constexpr double kLength = 20.0;  // m

struct Case {
  const char* name;
  DriveCondition how;
  double ate;  ///< m, at most
};

void PrintTo(const Case& test, std::ostream* out) { *out << test.how.name; }

/// 60 m of tables on hilly, rough ground.
sim::SolarFarmConfig hilly_farm(unsigned seed) {
  sim::SolarFarmConfig farm;
  farm.seed = seed;
  farm.size_east = farm.size_north = 60.0;
  farm.row_azimuth_rad = 75.0 * kDegree;
  farm.row_pitch = farm.table_length = 8.0;
  farm.terrain.rolling_amplitude = 0.8;
  farm.terrain.rolling_wavelength = 45.0;
  farm.terrain.rough_amplitude = 0.03;
  farm.terrain.rough_wavelength = 3.0;
  farm.terrain_cell = 0.5;
  return farm;
}

LaneOdometry drive_lane(const DriveCondition& how, unsigned seed) {
  const auto world = sim::make_solar_farm(hilly_farm(seed)).value();
  const auto scene = sim::Scene::create(world->mesh()).value();
  sim::LidarSpec lidar = sim::vlp16_spec();
  lidar.range_noise = how.noise;
  lidar = sim::at_rate(lidar, how.rate);
  const OdometryUse lidar_alone{"LiDAR"};
  return odometry_of_lanes(*world, *scene, lidar, how, kLength, seed, {&lidar_alone, 1}).front();
}

class OdometryConditions : public ::testing::TestWithParam<Case> {};

TEST_P(OdometryConditions, StaysTrueAndLosesNothing) {
  const auto& [name, how, ate] = GetParam();
  for (unsigned seed = 1; seed <= seeds_to_run(1); ++seed) {
    const LaneOdometry drove = drive_lane(how, seed);
    EXPECT_GT(drove.scans, 30u);
    EXPECT_EQ(drove.lost, 0u) << "seed " << seed;
    EXPECT_EQ(drove.map_restarts, 0u) << "seed " << seed;
    expect_at_most(drove.ate, ate, std::string("odometry, ") + how.name + ", ATE m", seed);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Lanes, OdometryConditions,
    ::testing::Values(
        Case{"Fast", {.name = "4 m/s", .speed = 4.0, .lane_share = 0.4}, 0.012},
        Case{"TurnsOfHalfTheRays",
             {.name = "turns at 120 deg/s, half of the rays",
              .lane_share = 0.2,
              .turn_rate = 120.0 * kDegree,
              .keep = 0.5},
             0.007},
        Case{"MastAt5Hz",
             {.name = "mast 5 Hz, 3 mm, 0.2 deg",
              .lane_share = 0.2,
              .shake = 5.0,
              .shake_way = 0.003,
              .shake_angle = 0.2 * kDegree},
             0.008},
        Case{"MastAt30Hz",
             {.name = "mast 30 Hz, 1 mm, 0.2 deg",
              .lane_share = 0.2,
              .shake = 30.0,
              .shake_way = 0.001,
              .shake_angle = 0.2 * kDegree},
             0.0213},
        Case{"FiveScansASecond", {.name = "5 Hz", .lane_share = 0.2, .rate = 5.0}, 0.0086},
        Case{"TwentyNoisyScansASecond",
             {.name = "20 Hz, noise 5 cm", .lane_share = 0.2, .noise = 0.05, .rate = 20.0},
             0.0124},
        Case{"EveryFifthScan", {.name = "every fifth scan (2 Hz)", .lane_share = 0.2, .every = 5}, 0.007}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace fleetmap::testing
