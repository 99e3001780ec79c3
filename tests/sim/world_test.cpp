#include "fleetmap/sim/world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "shapes.hpp"

namespace fleetmap::sim {
namespace {

using ::testing::HasSubstr;

std::shared_ptr<const World> made_world(Mesh mesh, const DrivableConfig& config = {}) {
  auto world = World::create(std::move(mesh), config);
  EXPECT_TRUE(world.has_value()) << (world ? "" : world.error().message);
  return world.value_or(nullptr);
}

TEST(World, GroundFollowsAPlane) {
  const auto world =
      made_world(test_ground({-10, -5}, {10, 5}, [](double x, double y) { return 3 + 0.2 * x - 0.1 * y; }));
  ASSERT_TRUE(world);
  EXPECT_DOUBLE_EQ(world->drivable_share(), 1.0);
  for (const Eigen::Vector2d& p :
       {Eigen::Vector2d(0, 0), Eigen::Vector2d(7.3, -2.2), Eigen::Vector2d(-9.1, 4.4)}) {
    EXPECT_NEAR(world->ground_height(p), 3 + 0.2 * p.x() - 0.1 * p.y(), 1e-4);
    EXPECT_TRUE(world->ground_normal(p).isApprox(Eigen::Vector3d(-0.2, 0.1, 1).normalized(), 1e-3));
  }
  // Outside: the nearest cell's.
  EXPECT_NEAR(world->ground_height({1000, 0}), world->ground_height({10, 0}), 1e-4);
  EXPECT_TRUE(std::isfinite(world->ground_height({std::nan(""), 0})));
}

TEST(World, WallsTablesAndStepsAreInTheWayWhatARobotPassesIsNot) {
  Mesh mesh = test_ground({-10, -10}, {10, 10}, [](double, double) { return 1.0; });
  append(mesh, test_box({-5.1, -5, 0.5}, {-5, 5, 3}));       // wall, its foot in the ground
  append(mesh, test_box({4, 4, 1.5}, {6, 6, 1.6}));          // a low table
  append(mesh, test_box({4, -6, 2.0}, {6, -4, 2.1}));        // a high table: a metre above the ground
  append(mesh, test_box({0.5, 0.5, 0.9}, {1.5, 1.5, 1.1}));  // a board to drive over
  const auto world = made_world(std::move(mesh));
  ASSERT_TRUE(world);
  EXPECT_TRUE(world->blocked({-5.05, 0}, 0.0));
  EXPECT_TRUE(world->blocked({-4.7, 0}, 0.4));
  EXPECT_FALSE(world->blocked({-4.3, 0}, 0.4));
  EXPECT_TRUE(world->blocked({5, 5}, 0.0));
  EXPECT_FALSE(world->blocked({5, -5}, 0.4));
  EXPECT_FALSE(world->blocked({1, 1}, 0.3));
  EXPECT_NEAR(world->ground_height({-5.05, 0}), 1.0, 1e-4);
  EXPECT_TRUE(world->blocked({10.5, 0}, 0.0));
  EXPECT_TRUE(world->blocked({std::nan(""), 0}, 0.1));
}

TEST(World, ClearanceIsTheDistanceToTheNearestCellInTheWay) {
  Mesh mesh = test_ground({-10, -10}, {10, 10}, [](double, double) { return 0.0; });
  append(mesh, test_box({2.05, -10, 0}, {2.2, 10, 1}));  // within the cells from 2 to 2.25
  const auto world = made_world(std::move(mesh));
  ASSERT_TRUE(world);
  for (double x = -3.0; x < 2.0; x += 0.37) EXPECT_NEAR(world->clearance({x, 1.1}, 20.0), 2.0 - x, 1e-9) << x;
  EXPECT_NEAR(world->clearance({4.25, 0}, 20.0), 2.0, 1e-9);
  EXPECT_DOUBLE_EQ(world->clearance({-9, 0}, 3.0), 3.0);
  EXPECT_DOUBLE_EQ(world->clearance({2.1, 0}, 3.0), 0.0);
  EXPECT_DOUBLE_EQ(world->clearance({11, 0}, 3.0), 0.0);
}

TEST(World, BlockedAgreesWithClearance) {
  Mesh mesh = test_ground({0, 0}, {12, 12}, [](double, double) { return 0.0; });
  for (int k = 0; k < 5; ++k) {
    const double x = 1.3 + 2.1 * k, y = std::fmod(3.7 * k, 11.0);
    append(mesh, test_box({x, y, 0}, {x + 0.1, y + 0.1, 2}));
  }
  const auto world = made_world(std::move(mesh));
  ASSERT_TRUE(world);
  int in_the_way = 0;
  for (double x = 0.05; x < 12; x += 0.31) {
    for (double y = 0.05; y < 12; y += 0.31) {
      const bool blocked = world->blocked({x, y}, 0.4);
      EXPECT_EQ(blocked, world->clearance({x, y}, 2.0) < 0.4);
      in_the_way += blocked ? 1 : 0;
    }
  }
  EXPECT_GT(in_the_way, 10);
}

TEST(World, SteepGroundIsInTheWayAndGentleGroundIsNot) {
  // Flat to x = 0, then 20 deg up to x = 5, then 40 deg.
  const auto ramp = [](double x, double) {
    return x < 0 ? 0.0 : x < 5 ? std::tan(0.349) * x : std::tan(0.349) * 5 + std::tan(0.698) * (x - 5);
  };
  for (const double cell : {0.25, 1.0}) {
    DrivableConfig config;
    config.cell = cell;
    const auto world = made_world(test_ground({-10, -5}, {10, 5}, ramp), config);
    ASSERT_TRUE(world);
    EXPECT_FALSE(world->blocked({-5, 0}, 0.3)) << cell;
    EXPECT_FALSE(world->blocked({2.5, 0}, 0.3)) << cell;
    EXPECT_TRUE(world->blocked({8, 0}, 0.0)) << cell;
  }
}

TEST(World, NarrowHolesAreBridgedWideOnesAreInTheWay) {
  Mesh mesh = test_ground({0, 0}, {10, 20}, [](double, double) { return 2.0; });
  append(mesh, test_ground({10.75, 0}, {20, 20}, [](double, double) { return 2.0; }));
  append(mesh, test_ground({25, 0}, {30, 20}, [](double, double) { return 2.0; }));
  const auto world = made_world(std::move(mesh));
  ASSERT_TRUE(world);
  EXPECT_FALSE(world->blocked({10.4, 10}, 0.3));
  EXPECT_NEAR(world->ground_height({10.4, 10}), 2.0, 1e-5);
  EXPECT_TRUE(world->blocked({22.5, 10}, 0.0));
}

TEST(World, SaysWhyItCannotBeDriven) {
  const auto error = [](Mesh mesh, const DrivableConfig& config = {}) {
    const auto world = World::create(std::move(mesh), config);
    return world ? std::string("no error") : world.error().message;
  };
  EXPECT_THAT(error(Mesh{}), HasSubstr("no triangles"));
  Mesh broken = test_box({0, 0, 0}, {5, 5, 1});
  broken.vertices[2].x() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(error(broken), HasSubstr("vertex 2"));
  broken = test_box({0, 0, 0}, {5, 5, 1});
  broken.triangles[1][0] = 99;
  EXPECT_THAT(error(broken), HasSubstr("vertex 99 of"));
  broken = test_box({0, 0, 0}, {5, 5, 1});
  broken.materials.pop_back();
  EXPECT_THAT(error(broken), HasSubstr("materials"));
  const auto cliff = [](double x, double) { return 3.0 * x; };
  EXPECT_THAT(error(test_ground({0, 0}, {10, 10}, cliff)), HasSubstr("cannot be driven"));
  EXPECT_THAT(error(test_ground({0, 0}, {10, 10}, cliff)), HasSubstr("max_slope_deg"));
  EXPECT_THAT(error(test_box({0, 0, 0}, {1e6, 1e6, 1})), HasSubstr("larger drivable.cell"));
  DrivableConfig config;
  config.cell = 0.0;
  EXPECT_THAT(error(test_box({0, 0, 0}, {5, 5, 1}), config), HasSubstr("cell must be"));
}

}  // namespace
}  // namespace fleetmap::sim
