#include "mission/blocked_places.hpp"

#include <gtest/gtest.h>

#include "planning/mission/small_plan.hpp"
#include "planning/sites.hpp"

namespace fleetmap::planning {
namespace {

using Eigen::Vector2d;
using testing::at;

const Polyline kPath = {{0.0, 0.0}, {10.0, 0.0}, {10.0, 20.0}};

/// Ground around two rows with one shed, at whose corners a way may turn.
RoutePlanner ground() {
  Mission mission;
  mission.rows = {{0, {{0, 0}, {40, 0}}}, {1, {{0, 20}, {40, 20}}}};
  mission.keep_out = {{{18, 6}, {22, 6}, {22, 8}, {18, 8}}};
  return *RoutePlanner::create(mission);
}

TEST(BlockedPlaces, ThePlaceLiesAheadOnThePath) {
  BlockedPlaces blocked;
  blocked.add(kPath, 5.0, {5.0, 0.0}, at(0.0));
  ASSERT_EQ(blocked.places().size(), 1u);
  EXPECT_LT((blocked.places()[0].centre - Vector2d(7.0, 0.0)).norm(), 1e-9);
  blocked.add(kPath, 13.0, {10.0, 3.0}, at(1.0));
  ASSERT_EQ(blocked.places().size(), 2u);
  EXPECT_LT((blocked.places()[1].centre - Vector2d(10.0, 5.0)).norm(), 1e-9);
}

TEST(BlockedPlaces, APlaceAtTheRobotIsLeftOut) {
  BlockedPlaces blocked;
  blocked.add(kPath, 5.0, {7.0, 1.0}, at(0.0));  // beside its path
  EXPECT_TRUE(blocked.places().empty());
}

TEST(BlockedPlaces, TheWayLeadsAroundThemUntilTheyAreOld) {
  const RoutePlanner planner = ground();
  BlockedPlaces blocked;
  blocked.add({{0.0, 0.0}, {40.0, 0.0}}, 18.0, {18.0, 0.0}, at(0.0));
  const auto around = blocked.route(planner, {0.0, 0.0}, {40.0, 0.0}, at(299.0));
  ASSERT_TRUE(around);
  EXPECT_GT(length_of(*around), 40.0 + 1e-3);
  const auto straight = blocked.route(planner, {0.0, 0.0}, {40.0, 0.0}, at(301.0));
  ASSERT_TRUE(straight);
  EXPECT_NEAR(length_of(*straight), 40.0, 1e-6);
  EXPECT_TRUE(blocked.places().empty());
}

TEST(BlockedPlaces, RouteLeadsThroughPlacesThatCannotBeAvoided) {
  const RoutePlanner planner = ground();
  BlockedPlaces blocked;
  // The goal itself is blocked.
  blocked.add({{0.0, 0.0}, {40.0, 0.0}}, 38.0, {20.0, 5.0}, at(0.0));
  ASSERT_EQ(blocked.places().size(), 1u);
  const auto way = blocked.route(planner, {0.0, 0.0}, {40.0, 0.0}, at(1.0));
  ASSERT_TRUE(way);
  EXPECT_NEAR(length_of(*way), 40.0, 1e-6);
}

TEST(BlockedPlaces, TheOldestGivesWay) {
  BlockedPlaces blocked;
  for (std::size_t k = 0; k <= BlockedPlaces::kMaxPlaces; ++k)
    blocked.add({{0.0, 0.0}, {100.0, 0.0}}, 5.0 * static_cast<double>(k), {0.0, 50.0}, at(0.0));
  ASSERT_EQ(blocked.places().size(), BlockedPlaces::kMaxPlaces);
  EXPECT_NEAR(blocked.places().front().centre.x(), 7.0, 1e-9);
}

}  // namespace
}  // namespace fleetmap::planning
