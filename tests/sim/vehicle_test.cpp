#include "fleetmap/sim/vehicle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "shapes.hpp"

namespace fleetmap::sim {
namespace {

constexpr double kStep = 0.005;

std::shared_ptr<const World> world(const std::function<double(double, double)>& height,
                                   const Mesh& more = {}) {
  Mesh mesh = test_ground({-20, -20}, {20, 20}, height);
  append(mesh, more);
  return World::create(std::move(mesh)).value();
}
std::shared_ptr<const World> level_world() {
  static const auto made = world([](double, double) { return 0.0; });
  return made;
}

void drive_for(Vehicle& vehicle, double seconds, double speed, double yaw_rate) {
  for (int k = 0; k < std::lround(seconds / kStep); ++k) vehicle.step(speed, yaw_rate, kStep);
}
double yaw_of(const Vehicle& vehicle) { return rpy_from_rotation(vehicle.T_enu_base().linear()).z(); }

TEST(Vehicle, StandsWhereItWasPut) {
  const Vehicle vehicle({}, level_world(), {3.0, -4.0}, 0.5);
  EXPECT_LT((vehicle.T_enu_base().translation() - Eigen::Vector3d(3.0, -4.0, 0.1)).norm(), 1e-6);
  EXPECT_NEAR(yaw_of(vehicle), 0.5, 1e-9);
  EXPECT_EQ(vehicle.speed(), 0.0);
  EXPECT_EQ(vehicle.odometer(), 0.0);
  EXPECT_FALSE(vehicle.touching());
}

TEST(Vehicle, AcceleratesAsItCanAndNoFasterThanItMay) {
  VehicleSpec spec;
  spec.lag = 0.0;
  Vehicle vehicle(spec, level_world(), {-10.0, 0.0}, 0.0);
  drive_for(vehicle, 1.0, 5.0, 9.0);
  EXPECT_NEAR(vehicle.speed(), 1.0, 1e-9) << "1 m/s^2";
  EXPECT_NEAR(vehicle.yaw_rate(), 1.5, 1e-9) << "its fastest, after half a second";
  drive_for(vehicle, 2.0, 5.0, 0.0);
  EXPECT_NEAR(vehicle.speed(), 2.0, 1e-9) << "its fastest";
  EXPECT_NEAR(vehicle.yaw_rate(), 0.0, 1e-9);
  EXPECT_NEAR(vehicle.odometer(), 0.5 + 1.5 + 2.0, 0.02);
}

TEST(Vehicle, MotorsLagBehindTheCommand) {
  VehicleSpec spec;
  spec.acceleration = spec.yaw_acceleration = 1e3;
  spec.lag = 0.2;
  Vehicle vehicle(spec, level_world(), {0.0, 0.0}, 0.0);
  drive_for(vehicle, 0.2, 1.0, 1.0);
  EXPECT_NEAR(vehicle.speed(), 1.0 - std::exp(-1.0), 0.01);
  EXPECT_NEAR(vehicle.yaw_rate(), 1.0 - std::exp(-1.0), 0.01);
}

TEST(Vehicle, DrivesCirclesOfSpeedByYawRateEitherWay) {
  for (const double way : {1.0, -1.0}) {
    Vehicle vehicle({}, level_world(), {0.0, 0.0}, 0.0);
    drive_for(vehicle, 3.0, way, 0.5);
    const Eigen::Vector2d from = vehicle.T_enu_base().translation().head<2>();
    const double yaw = yaw_of(vehicle);
    drive_for(vehicle, std::numbers::pi / 0.5, way, 0.5);
    const Eigen::Vector2d move = vehicle.T_enu_base().translation().head<2>() - from;
    EXPECT_NEAR(move.norm(), 4.0, 0.01) << "half a circle of 2 m radius";
    EXPECT_NEAR(wrap_angle(yaw_of(vehicle) - yaw - std::numbers::pi), 0.0, 0.01);
    const Eigen::Vector2d left(-std::sin(yaw), std::cos(yaw));
    EXPECT_NEAR(move.dot(left), way * 4.0, 0.01);
  }
}

TEST(Vehicle, EnergyIsThatOfTimeWayAndTurns) {
  VehicleSpec spec;
  spec.battery_wh = 1.0;  // 3600 J
  spec.idle_power_w = 36.0;
  spec.energy_per_metre = spec.energy_per_radian = 0.0;
  Vehicle idle(spec, level_world(), {0.0, 0.0}, 0.0);
  drive_for(idle, 10.0, 0.0, 0.0);
  EXPECT_NEAR(idle.battery_wh(), 0.9, 1e-9);
  spec.idle_power_w = 0.0;
  spec.energy_per_metre = 360.0;
  Vehicle driven(spec, level_world(), {0.0, 0.0}, 0.0);
  drive_for(driven, 3.0, -1.0, 0.0);
  EXPECT_NEAR(driven.battery_wh(), 1.0 - 0.1 * driven.odometer(), 1e-9);
  EXPECT_GT(driven.odometer(), 2.0);
  spec.energy_per_metre = 0.0;
  spec.energy_per_radian = 360.0;
  Vehicle turned(spec, level_world(), {0.0, 0.0}, 0.0);
  drive_for(turned, 2.0, 0.0, 1.0);
  EXPECT_NEAR(turned.battery_wh(), 1.0 - 0.1 * yaw_of(turned), 1e-6);
}

TEST(Vehicle, WithoutBatteryItRollsOutAndStands) {
  VehicleSpec spec;
  spec.battery_wh = 0.05;  // 180 J: 2 s
  spec.idle_power_w = 90.0;
  spec.energy_per_metre = 0.0;
  Vehicle vehicle(spec, level_world(), {0.0, 0.0}, 0.0);
  drive_for(vehicle, 1.9, 1.0, 0.0);
  EXPECT_GT(vehicle.speed(), 0.95);
  drive_for(vehicle, 3.0, 1.0, 1.0);
  EXPECT_EQ(vehicle.battery_wh(), 0.0);
  EXPECT_LT(vehicle.speed(), 1e-3);
  EXPECT_LT(vehicle.yaw_rate(), 1e-3);
}

TEST(Vehicle, ACommandThatIsNoNumberIsAStop) {
  Vehicle vehicle({}, level_world(), {0.0, 0.0}, 0.0);
  drive_for(vehicle, 2.0, 1.0, 0.0);
  drive_for(vehicle, 3.0, std::nan(""), 1.0);
  EXPECT_NEAR(vehicle.speed(), 0.0, 1e-6);
  EXPECT_NEAR(yaw_of(vehicle), 0.0, 1e-9) << "not even half of it is obeyed";
  const Pose before = vehicle.T_enu_base();
  for (const double dt : {0.0, -1.0, std::nan("")}) vehicle.step(1.0, 1.0, dt);
  EXPECT_EQ(vehicle.T_enu_base().matrix(), before.matrix()) << "no time has passed";
}

TEST(Vehicle, OnASlopeItsZAxisIsTheGroundsNormalAndTheWayIsMeasuredAlongIt) {
  const double rise = 0.2;
  const Vehicle standing({}, world([&](double x, double) { return rise * x; }), {0.0, 0.0}, 0.0);
  const Eigen::Vector3d normal = Eigen::Vector3d(-rise, 0, 1).normalized();
  EXPECT_LT((standing.T_enu_base().linear().col(2) - normal).norm(), 1e-3);
  EXPECT_LT((standing.T_enu_base().translation() - 0.1 * normal).norm(), 1e-3);
  Vehicle vehicle = standing;
  drive_for(vehicle, 5.0, 1.0, 0.0);
  const Eigen::Vector3d way = vehicle.T_enu_base().translation() - standing.T_enu_base().translation();
  EXPECT_NEAR(way.z() / way.x(), rise, 1e-3);
  EXPECT_NEAR(way.norm() / vehicle.odometer(), 1.0, 1e-3);
}

TEST(Vehicle, StopsShortOfAWallAndTouchesItUntilToldOtherwise) {
  const auto walled = world([](double, double) { return 0.0; }, test_box({5, -15, -1}, {5.5, 15, 2}));
  Vehicle vehicle({}, walled, {0.0, 0.0}, 0.0);
  drive_for(vehicle, 6.0, 2.0, 0.0);
  EXPECT_TRUE(vehicle.touching());
  EXPECT_LT(vehicle.speed(), 0.02);
  const double x = vehicle.T_enu_base().translation().x();
  EXPECT_GT(x, 4.3);
  EXPECT_LE(x, 5.0 - VehicleSpec{}.radius);
  drive_for(vehicle, 1.0, 0.0, 0.0);
  EXPECT_TRUE(vehicle.touching());
  drive_for(vehicle, 2.0, -1.0, 0.0);
  EXPECT_FALSE(vehicle.touching());
  EXPECT_LT(vehicle.T_enu_base().translation().x(), x - 0.8);
}

}  // namespace
}  // namespace fleetmap::sim
