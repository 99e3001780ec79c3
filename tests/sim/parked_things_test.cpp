#include "fleetmap/sim/parked_things.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fleetmap/sim/solar_farm.hpp"

namespace fleetmap::sim {
namespace {

std::shared_ptr<const World> farm_with_roads() {
  SolarFarmConfig config;
  config.size_east = 70.0;
  config.size_north = 60.0;
  config.road_every = 3;
  config.trees = 0;
  config.seed = 11;
  return make_solar_farm(config).value();
}

/// m^2 of the site that something stands on.
double blocked_area(const World& world) {
  double area = 0.0;
  for (double x = -34.0; x < 34.0; x += 0.25) {
    for (double y = -29.0; y < 29.0; y += 0.25) area += world.blocked({x, y}, 0.0) ? 0.0625 : 0.0;
  }
  return area;
}

int lanes_in_the_way(const World& world) {
  int lanes = 0;
  for (const Aisle& lane : world.aisles()) {
    bool blocked = false;
    for (double t = 0.0; t <= 1.0; t += 0.005)
      blocked |= world.blocked(lane.from + t * (lane.to - lane.from), 0.35);
    lanes += blocked ? 1 : 0;
  }
  return lanes;
}

TEST(ParkedThings, StandInTheWorldButNotInItsDrawing) {
  const auto empty = farm_with_roads();
  ASSERT_EQ(lanes_in_the_way(*empty), 0);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto world = with_parked_things(*empty, 6, seed, {});
    ASSERT_TRUE(world) << world.error().message;
    const double more = blocked_area(**world) - blocked_area(*empty);
    EXPECT_GT(more, 6 * 1.0) << "at least a pallet each";
    EXPECT_LT(more, 6 * 20.0);
    EXPECT_GE(lanes_in_the_way(**world), 2);
    EXPECT_EQ((*world)->drawing().keep_out, empty->drawing().keep_out);
    EXPECT_EQ((*world)->drawing().boundary, empty->drawing().boundary);
    for (double x = -30.0; x < 30.0; x += 1.0) {
      const double step = (*world)->ground_height({x, 3.0}) - empty->ground_height({x, 3.0});
      EXPECT_LT(std::abs(step), 0.35) << "nothing of them is taken for a hill";
    }
  }
}

TEST(ParkedThings, LeaveRoomAroundTheStarts) {
  const auto empty = farm_with_roads();
  const std::vector<Eigen::Vector2d> starts = {
      empty->aisles()[0].from, empty->aisles()[1].from, {0.0, empty->aisles()[2].from.y()}};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto world = with_parked_things(*empty, 8, seed, starts);
    ASSERT_TRUE(world) << world.error().message;
    for (const Eigen::Vector2d& start : starts)
      EXPECT_NEAR((*world)->clearance(start, 3.0), empty->clearance(start, 3.0), 1e-9) << seed;
  }
}

TEST(ParkedThings, TheSameSeedGivesTheSameWorld) {
  const auto empty = farm_with_roads();
  const auto vertices = [&](std::uint64_t seed) {
    return with_parked_things(*empty, 4, seed, {}).value()->mesh().vertices;
  };
  EXPECT_EQ(vertices(1), vertices(1));
  EXPECT_NE(vertices(1), vertices(2));
}

TEST(ParkedThings, TooManyAreRefused) {
  const auto world = with_parked_things(*farm_with_roads(), 900, 1, {});
  ASSERT_FALSE(world);
  EXPECT_THAT(world.error().message, ::testing::HasSubstr("no room for 900 parked things"));
}

}  // namespace
}  // namespace fleetmap::sim
