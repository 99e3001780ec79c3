#include "fleetmap/planning/driving/path_follower.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "planning/driving/aisle_world.hpp"

namespace fleetmap::planning {
namespace {

using Eigen::Vector2d;
using testing::AisleWorld;

struct DriveOutcome {
  bool finished = false;
  bool stuck = false;
  double time = 0.0;
};

/// The loop at 10 Hz until the follower is finished or stuck; `error` is that of the known position.
DriveOutcome drive(AisleWorld& world, PathFollower& follower, const std::function<Vector2d(double)>& error,
                   double limit = 400.0) {
  const double dt = 0.1;
  for (int k = 0; k * dt < limit; ++k) {
    const Stamp now = stamp_from_ns(static_cast<std::int64_t>(k) * 100'000'000);
    Pose2 known = world.truth;
    known.position += error(k * dt);
    const Command command = follower.update(known, world.speed, world.scan(), now);
    if (follower.finished()) return {true, false, k * dt};
    if (follower.stuck(now)) return {false, true, k * dt};
    world.step(command, dt);
  }
  return {false, false, limit};
}

Vector2d none(double) { return Vector2d::Zero(); }

/// 3 m between posts every 2.5 m and the low edges of the tables.
AisleWorld aisle(double length) {
  AisleWorld world;
  for (const double y : {-1.5, 1.5}) {
    world.wall({0.0, y}, {length, y}, 0.3);
    for (double x = 0.0; x <= length; x += 2.5) world.box({x, y - 0.05}, {x + 0.1, y + 0.05});
  }
  world.truth = {{-3.0, 0.0}, 0.0};
  return world;
}

TEST(PathFollower, DrivesAnOpenPathWithItsCorners) {
  AisleWorld world;
  PathFollower follower;
  follower.set_path({{0, 0}, {20, 0}, {20, 10}, {0, 10}, {0, 14}});
  const DriveOutcome outcome = drive(world, follower, none);
  EXPECT_TRUE(outcome.finished);
  EXPECT_LT((world.truth.position - Vector2d(0, 14)).norm(), 0.8);
  EXPECT_LT(outcome.time, 60.0);
  EXPECT_NEAR(world.driven, 54.0, 6.0);
}

TEST(PathFollower, KeepsToTheMiddleOfAnAisleWithAnErrorOfItsPosition) {
  for (const double bias : {-1.5, 0.0, 1.5}) {
    AisleWorld world = aisle(200.0);
    PathFollower follower;
    follower.set_path({{-3.0, 0.0}, {200.0, 0.0}});
    const auto error = [bias](double t) {
      return Vector2d(0.4 * std::sin(0.05 * t), bias + 0.4 * std::sin(0.03 * t));
    };
    const DriveOutcome outcome = drive(world, follower, error);
    EXPECT_TRUE(outcome.finished) << bias;
    EXPECT_GT(world.truth.position.x(), 197.0) << bias;
    EXPECT_GT(world.nearest, 0.6) << bias;                // of 1.5 m in the middle
    EXPECT_LT(outcome.time, 1.25 * 203.0 / 1.5) << bias;  // and at speed
    EXPECT_LT(world.reversals, 6) << bias;
  }
}

TEST(PathFollower, GoesAroundAPalletInTheAisle) {
  for (const double bias : {-1.2, 0.0, 1.2}) {
    AisleWorld world = aisle(40.0);
    world.box({20.0, -0.4}, {21.2, 0.0});  // 1.1 and 1.5 m are left
    PathFollower follower;
    follower.set_path({{-3.0, 0.0}, {40.0, 0.0}});
    const DriveOutcome outcome = drive(world, follower, [bias](double) { return Vector2d(0.0, bias); });
    EXPECT_TRUE(outcome.finished) << bias;
    EXPECT_GT(world.truth.position.x(), 37.0) << bias;
    EXPECT_GT(world.nearest, world.radius) << bias;
  }
}

TEST(PathFollower, PassesANarrowGate) {
  for (const double bias : {-1.0, 0.0, 1.0}) {
    AisleWorld world;
    world.wall({15.0, -8.0}, {15.0, -0.6});
    world.wall({15.0, 0.6}, {15.0, 8.0});
    PathFollower follower;
    follower.set_path({{0.0, 0.0}, {30.0, 0.0}});
    const DriveOutcome outcome = drive(world, follower, [bias](double) { return Vector2d(0.0, bias); });
    EXPECT_TRUE(outcome.finished) << bias;
    EXPECT_GT(world.truth.position.x(), 28.0) << bias;
    EXPECT_GT(world.nearest, world.radius) << bias;
  }
}

TEST(PathFollower, SaysThatItIsStuckInADeadEndAndTouchesNothing) {
  AisleWorld world = aisle(60.0);
  world.wall({30.0, -1.5}, {30.0, 1.5});
  PathFollower follower;
  follower.set_path({{-3.0, 0.0}, {60.0, 0.0}});
  const DriveOutcome outcome = drive(world, follower, none);
  EXPECT_FALSE(outcome.finished);
  EXPECT_TRUE(outcome.stuck);
  EXPECT_GT(world.nearest, world.radius);
  // It gets out again.
  follower.set_path({world.truth.position, {-3.0, 0.0}});
  EXPECT_TRUE(drive(world, follower, none).finished);
  EXPECT_GT(world.nearest, world.radius);
}

TEST(PathFollower, AWaypointInsideAnObstacleCountsAsReached) {
  AisleWorld world;
  world.box({9.0, -1.0}, {11.0, 1.0});   // on a corner of the path
  world.box({9.4, 19.4}, {10.6, 20.6});  // and on its end
  PathFollower follower;
  follower.set_path({{0.0, 0.0}, {10.0, 0.0}, {10.0, 20.0}});
  const DriveOutcome outcome = drive(world, follower, none, 120.0);
  EXPECT_TRUE(outcome.finished);
  EXPECT_LT((world.truth.position - Vector2d(10.0, 20.0)).norm(), 4.0);
  EXPECT_GT(world.nearest, world.radius);
}

TEST(PathFollower, TurnsFromOneAisleIntoTheNext) {
  for (const double bias : {-1.2, 0.0, 1.2}) {
    AisleWorld world;
    for (const double y : {-1.5, 1.5, 4.0, 6.5, 9.5}) world.wall({0.0, y}, {30.0, y}, 0.2);
    world.truth = {{1.0, 0.0}, 0.0};
    PathFollower follower;
    follower.set_path({{1.0, 0.0}, {32.5, 0.0}, {32.5, 8.0}, {1.0, 8.0}});
    const DriveOutcome outcome =
        drive(world, follower, [bias](double) { return Vector2d(0.3 * bias, bias); });
    EXPECT_TRUE(outcome.finished) << bias;
    EXPECT_LT((world.truth.position - Vector2d(1.0, 8.0)).norm(), 2.5) << bias;
    EXPECT_GT(world.nearest, world.radius) << bias;
  }
}

TEST(PathFollower, BadInputStopsTheRobot) {
  PathFollower follower;
  const double nan = std::nan("");
  EXPECT_TRUE(follower.finished());
  follower.set_path({{nan, 0.0}, {0.0, 0.0}});
  EXPECT_TRUE(follower.finished());
  follower.set_path({{0.0, 0.0}, {10.0, 0.0}});
  const Command command = follower.update({{nan, 0.0}, 0.0}, 0.0, {}, stamp_from_ns(0));
  EXPECT_EQ(command.forward_speed, 0.0);
  EXPECT_EQ(command.yaw_rate, 0.0);
  const Command careful =
      follower.update({{0.0, 0.0}, 0.0}, nan, {{nan, 0.0}, {1e300, -1e300}}, stamp_from_ns(100'000'000));
  EXPECT_TRUE(std::isfinite(careful.forward_speed) && std::isfinite(careful.yaw_rate));
  EXPECT_GT(careful.forward_speed, 0.0);
  PathFollowerConfig wrong;
  wrong.max_speed = -1.0;
  EXPECT_THROW(PathFollower{wrong}, std::invalid_argument);
}

}  // namespace
}  // namespace fleetmap::planning
