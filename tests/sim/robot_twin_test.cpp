#include "fleetmap/sim/robot_twin.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "shapes.hpp"
#include "sim/stamps.hpp"

namespace fleetmap::sim {
namespace {

using ::testing::HasSubstr;

const GeoPoint kOrigin = geo_point_from_degrees(49.0, 8.4, 110.0);

std::shared_ptr<const World> world_of(Mesh mesh) {
  auto world = World::create(std::move(mesh));
  EXPECT_TRUE(world.has_value()) << (world ? "" : world.error().message);
  return world.value_or(nullptr);
}

/// Level ground with a wall at x = 10.
std::shared_ptr<const World> walled() {
  Mesh mesh = test_ground({-40, -40}, {40, 40}, [](double, double) { return 0.0; });
  append(mesh, test_box({10, -30, -1}, {10.5, 30, 3}));
  return world_of(std::move(mesh));
}

RobotTwinConfig robot() {
  RobotTwinConfig config;
  config.lidar = vlp16_spec();
  config.T_base_lidar.translation() = Eigen::Vector3d(0, 0, 0.35);
  config.T_base_imu.translation() = Eigen::Vector3d(0.1, 0, 0.1);
  return config;
}

RobotTwin made_twin(const std::shared_ptr<const World>& world, const RobotTwinConfig& config) {
  auto twin = RobotTwin::create(world, kOrigin, config, at(0));
  EXPECT_TRUE(twin.has_value()) << (twin ? "" : twin.error().message);
  return std::move(twin.value());
}

/// Commands again and again until `until` s.
std::vector<TwinSample> drive(RobotTwin& twin, double until, double speed, double yaw_rate) {
  std::vector<TwinSample> all;
  while (to_seconds(twin.now()) + 0.09 < until) {
    twin.command(speed, yaw_rate);
    for (TwinSample& sample : twin.advance(twin.now() + std::chrono::milliseconds(100))) {
      all.push_back(std::move(sample));
    }
  }
  return all;
}

TEST(RobotTwin, ReachesTheWantedSpeedWithItsAcceleration) {
  RobotTwin twin = made_twin(walled(), robot());
  drive(twin, 0.5, -1.5, 0.0);
  EXPECT_GT(twin.speed(), -0.51);
  EXPECT_LT(twin.speed(), -0.3);
  drive(twin, 4.0, -1.5, 0.0);
  EXPECT_NEAR(twin.speed(), -1.5, 1e-3);
  EXPECT_NEAR(twin.odometer(), -twin.T_enu_base().translation().x(), 1e-6);
  EXPECT_NEAR(twin.odometer(), 1.5 * 4.0 - 0.5 * 1.5 * 1.5, 0.2);
  drive(twin, 8.0, -9.0, 0.0);
  EXPECT_NEAR(twin.speed(), -2.0, 1e-3);
}

TEST(RobotTwin, TurnsOnTheSpot) {
  RobotTwin twin = made_twin(walled(), robot());
  drive(twin, 4.0, 0.0, 0.5);
  EXPECT_NEAR(rpy_from_rotation(twin.T_enu_base().linear()).z(), 1.95, 0.02);  // 0.1 s to get going
  EXPECT_LT(twin.T_enu_base().translation().head<2>().norm(), 1e-6);
}

TEST(RobotTwin, ACommandIsForgotten) {
  RobotTwin twin = made_twin(walled(), robot());
  twin.command(-1.0, 0.0);
  twin.advance(at(0.45));
  EXPECT_LT(twin.speed(), -0.3);
  twin.advance(at(3.0));
  EXPECT_NEAR(twin.speed(), 0.0, 1e-6);
}

TEST(RobotTwin, WithoutATimeoutTheLastCommandHolds) {
  RobotTwinConfig config = robot();
  config.vehicle.command_timeout = 0.0;
  RobotTwin twin = made_twin(walled(), config);
  twin.command(1.0, 0.0);
  twin.advance(at(6));
  EXPECT_NEAR(twin.speed(), 1.0, 0.02);
  twin.command(0.0, 0.0);
  twin.advance(at(9));
  EXPECT_NEAR(twin.speed(), 0.0, 1e-3);
}

TEST(RobotTwin, StopsAtAWallTurnsAndBacksOff) {
  const auto world = walled();
  RobotTwin twin = made_twin(world, robot());
  drive(twin, 15.0, 2.0, 0.0);
  EXPECT_TRUE(twin.touching());
  EXPECT_NEAR(twin.speed(), 0.0, 1e-2);
  const double x = twin.T_enu_base().translation().x();
  EXPECT_GT(x, 8.7);
  EXPECT_FALSE(world->blocked({x, 0.0}, robot().vehicle.radius));
  drive(twin, 16.0, 0.0, 0.5);
  EXPECT_GT(rpy_from_rotation(twin.T_enu_base().linear()).z(), 0.2);
  drive(twin, 18.0, -1.0, 0.0);
  EXPECT_FALSE(twin.touching());
  EXPECT_LT(twin.T_enu_base().translation().x(), x - 0.5);
}

TEST(RobotTwin, NeverStandsInsideAnything) {
  Mesh mesh = test_ground({-15, -15}, {15, 15}, [](double, double) { return 0.0; });
  for (int k = 0; k < 12; ++k) {
    const double x = -9.0 + 6.0 * (k % 4), y = -6.0 + 6.0 * (k / 4);
    append(mesh, test_box({x, y, -1}, {x + 1, y + 1, 2}));
  }
  const auto world = world_of(std::move(mesh));
  RobotTwinConfig config = robot();
  config.start = {-4.0, -9.0};
  RobotTwin twin = made_twin(world, config);
  for (int k = 0; k < 600; ++k) {
    twin.command(2.0 * std::sin(0.13 * k), 1.5 * std::cos(0.071 * k));
    twin.advance(twin.now() + std::chrono::milliseconds(200));
    const Eigen::Vector2d p = twin.T_enu_base().translation().head<2>();
    ASSERT_FALSE(world->blocked(p, config.vehicle.radius)) << k << ": " << p.transpose();
  }
  EXPECT_GT(twin.odometer(), 20.0);
}

TEST(RobotTwin, FollowsTheTerrainSmoothly) {
  const auto hills = [](double x, double y) { return 0.8 * std::sin(0.25 * x) + 0.4 * std::cos(0.3 * y); };
  RobotTwinConfig config = robot();
  config.start = {-30.0, 3.0};
  config.imu.gyro_noise = config.imu.accel_noise = config.imu.gyro_bias_sigma = 0.0;
  config.imu.accel_bias_sigma = 0.0;
  RobotTwin twin = made_twin(world_of(test_ground({-40, -40}, {40, 40}, hills)), config);
  double worst_force = 0.0, worst_turn = 0.0;
  for (int k = 1; k <= 400; ++k) {
    twin.command(1.5, 0.0);
    for (const TwinSample& sample : twin.advance(at(0.1 * k))) {
      if (const auto* imu = std::get_if<sensor::Imu>(&sample)) {
        worst_force = std::max(worst_force, std::abs(imu->specific_force.norm() - 9.80665));
        worst_turn = std::max(worst_turn, imu->angular_velocity.norm());
      }
    }
    const Pose T = twin.T_enu_base();
    const Eigen::Vector3d foot = T * Eigen::Vector3d(0, 0, -config.vehicle.base_height);
    EXPECT_NEAR(foot.z(), hills(foot.x(), foot.y()), 0.04);
    const double x = foot.x(), y = foot.y();
    const Eigen::Vector3d normal(-0.2 * std::cos(0.25 * x), 0.12 * std::sin(0.3 * y), 1.0);
    EXPECT_LT(std::acos(std::min(1.0, normal.normalized().dot(T.linear().col(2)))), 0.04);
  }
  EXPECT_GT(twin.T_enu_base().translation().x(), 20.0);
  EXPECT_LT(worst_force, 2.5);
  EXPECT_LT(worst_turn, 0.5);
}

TEST(RobotTwin, ImuIntegratesToTheTruth) {
  const auto hills = [](double x, double y) { return 0.5 * std::sin(0.25 * x + 0.1 * y); };
  RobotTwinConfig config = robot();
  config.start = {-10.0, 0.0};
  config.imu.gyro_noise = config.imu.accel_noise = config.imu.gyro_bias_sigma = 0.0;
  config.imu.accel_bias_sigma = config.imu.gyro_bias_walk = config.imu.accel_bias_walk = 0.0;
  RobotTwin twin = made_twin(world_of(test_ground({-40, -40}, {40, 40}, hills)), config);
  Pose T = twin.T_enu_base() * config.T_base_imu;
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  for (const TwinSample& sample : drive(twin, 20.0, 1.0, 0.3)) {
    const auto* imu = std::get_if<sensor::Imu>(&sample);
    if (imu == nullptr) continue;
    const Eigen::Matrix3d middle = T.linear() * so3_exp(0.005 * imu->angular_velocity);
    const Eigen::Vector3d a = middle * imu->specific_force - Eigen::Vector3d(0, 0, 9.80665);
    T.translation() += 0.01 * v + 5e-5 * a;
    v += 0.01 * a;
    T.linear() = T.linear() * so3_exp(0.01 * imu->angular_velocity);
  }
  const Pose truth = twin.T_enu_base() * config.T_base_imu;
  EXPECT_LT((T.translation() - truth.translation()).norm(), 0.02);
  EXPECT_LT(so3_log(T.linear().transpose() * truth.linear()).norm(), 1e-6);
}

TEST(RobotTwin, SamplesComeInOrderAtTheirRates) {
  RobotTwinConfig config = robot();
  config.lidar = at_rate(vlp16_spec(), 7.0);  // no multiple of the physics' step
  RobotTwin twin = made_twin(walled(), config);
  int imus = 0, fixes = 0, wheels = 0, scans = 0;
  Stamp last{};
  for (const TwinSample& sample : drive(twin, 10.0, 0.5, 0.4)) {
    EXPECT_GE(due(sample), last);
    last = due(sample);
    imus += std::holds_alternative<sensor::Imu>(sample);
    fixes += std::holds_alternative<sensor::Fix>(sample);
    wheels += std::holds_alternative<sensor::Wheel>(sample);
    if (const auto* job = std::get_if<ScanJob>(&sample)) {
      EXPECT_EQ(job->number, static_cast<std::uint64_t>(scans));
      EXPECT_NEAR(to_seconds(job->stamp), scans / 7.0, 1e-8);
      EXPECT_NEAR(to_seconds(due(sample) - job->stamp), 1.0 / 7.0, 1e-7);
      ++scans;
    }
  }
  EXPECT_EQ(imus, 1000);
  EXPECT_EQ(fixes, 50);
  EXPECT_EQ(wheels, 200);
  EXPECT_EQ(scans, 70);
}

TEST(RobotTwin, ScansStartAtThePoseOfTheirStamp) {
  RobotTwinConfig config = robot();
  RobotTwin twin = made_twin(walled(), config);
  Pose begin = twin.T_enu_base();
  for (int k = 1; k <= 30; ++k) {
    twin.command(-1.0, 0.8);
    for (const TwinSample& sample : twin.advance(at(0.1 * k))) {
      const auto* job = std::get_if<ScanJob>(&sample);
      if (job == nullptr) continue;
      EXPECT_EQ(job->stamp, at(0.1 * (k - 1)));
      EXPECT_TRUE(job->T_enu_lidar.front().isApprox(begin * config.T_base_lidar, 1e-12));
      EXPECT_TRUE(job->T_enu_lidar.back().isApprox(twin.T_enu_base() * config.T_base_lidar, 1e-12));
    }
    begin = twin.T_enu_base();
  }
}

TEST(RobotTwin, TheScanUnderWayHasTheFirstPosesOfTheOneThatBecomesDue) {
  RobotTwinConfig config = robot();
  config.lidar = at_rate(vlp16_spec(), 7.0);  // no multiple of the physics' step
  RobotTwin twin = made_twin(walled(), config);
  std::vector<ScanJob> under_way;
  std::size_t compared = 0;
  for (int k = 1; k <= 100; ++k) {
    twin.command(1.0, 0.6);
    for (const TwinSample& sample : twin.advance(at(0.02 * k))) {
      const auto* job = std::get_if<ScanJob>(&sample);
      if (job == nullptr) continue;
      for (const ScanJob& part : under_way) {
        EXPECT_EQ(part.number, job->number);
        EXPECT_EQ(part.stamp, job->stamp);
        EXPECT_EQ(part.step, job->step);
        EXPECT_EQ(part.seed, job->seed);
        ASSERT_LE(part.T_enu_lidar.size(), job->T_enu_lidar.size());
        for (std::size_t p = 0; p < part.T_enu_lidar.size(); ++p, ++compared)
          EXPECT_EQ(part.T_enu_lidar[p].matrix(), job->T_enu_lidar[p].matrix());
      }
      under_way.clear();
    }
    under_way.push_back(twin.scan_under_way());
    EXPECT_LE(due(under_way.back()), twin.now());
  }
  EXPECT_GT(compared, 500u);
}

TEST(RobotTwin, SameCommandsSameSamplesHoweverOneAsks) {
  const auto run = [](double step) {
    RobotTwin twin = made_twin(walled(), robot());
    std::vector<double> values;
    for (int second = 0; second < 4; ++second) {
      twin.command(-1.0, 0.5);
      for (double t = step; t < 1.0 + 0.5 * step; t += step) {
        for (const TwinSample& sample : twin.advance(at(second + t))) {
          if (const auto* imu = std::get_if<sensor::Imu>(&sample)) {
            values.push_back(imu->specific_force.x());
          }
          if (const auto* fix = std::get_if<sensor::Fix>(&sample)) values.push_back(fix->position.latitude);
          if (const auto* wheel = std::get_if<sensor::Wheel>(&sample)) values.push_back(wheel->forward_speed);
        }
      }
    }
    return values;
  };
  const std::vector<double> once = run(1.0);
  EXPECT_EQ(once.size(), 500u);
  EXPECT_EQ(once, run(0.0625));
}

TEST(RobotTwin, AnEmptyBatteryStandsStill) {
  RobotTwinConfig config = robot();
  config.vehicle.battery_wh = 0.1;  // 360 J: 3.4 s at 45 W and 60 J/m
  RobotTwin twin = made_twin(walled(), config);
  drive(twin, 2.0, -1.0, 0.0);
  EXPECT_GT(twin.battery_wh(), 0.0);
  EXPECT_LT(twin.speed(), -0.9);
  drive(twin, 12.0, -1.0, 0.0);
  EXPECT_EQ(twin.battery_wh(), 0.0);
  EXPECT_NEAR(twin.speed(), 0.0, 1e-3);
  EXPECT_FALSE(twin.touching());
}

TEST(RobotTwin, ABadStartSaysWhereAndWhatToDo) {
  const auto error = [](const Eigen::Vector2d& start) {
    RobotTwinConfig config = robot();
    config.start = start;
    const auto twin = RobotTwin::create(walled(), kOrigin, config, at(0));
    return twin ? "no error" : twin.error().message;
  };
  EXPECT_THAT(error({10.2, 1.0}), HasSubstr("[10.20, 1.00] is inside something"));
  EXPECT_THAT(error({10.2, 1.0}), HasSubstr("0.35 m needed; set start to ["));
  EXPECT_THAT(error({55.0, 0.0}), HasSubstr("[55.00, 0.00] is outside the world"));
  EXPECT_THAT(error({55.0, 0.0}), HasSubstr("set start to ["));
  EXPECT_THAT(error({1e6, 0.0}), HasSubstr("set start to a free place"));
  EXPECT_THAT(error({std::nan(""), 0.0}), HasSubstr("start"));
}

TEST(RobotTwin, ABadSpecNamesItsSectionAndField) {
  RobotTwinConfig config = robot();
  config.vehicle.max_speed = -1.0;
  EXPECT_THAT(RobotTwin::create(walled(), kOrigin, config, at(0)).error().message,
              HasSubstr("vehicle.max_speed"));
  config = robot();
  config.gps.rate = 0.0;
  EXPECT_THAT(RobotTwin::create(walled(), kOrigin, config, at(0)).error().message, HasSubstr("gps.rate"));
}

}  // namespace
}  // namespace fleetmap::sim
