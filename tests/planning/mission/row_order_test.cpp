#include "mission/row_order.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "planning/sites.hpp"

namespace fleetmap::planning {
namespace {

/// Three lanes of 60 m along x; both robots begin at their west ends and need not meet.
std::shared_ptr<const FleetPlan> lanes() {
  Mission mission;
  mission.rows = {{5, {{0, 0}, {60, 0}}}, {6, {{0, 10}, {60, 10}}}, {7, {{0, 20}, {60, 20}}}};
  MissionConfig config;
  config.rendezvous = false;
  auto plan = plan_fleet(std::move(mission), testing::fleet(2), config);
  EXPECT_TRUE(plan) << (plan ? "" : plan.error().message);
  return *plan;
}

TEST(RowOrder, TheNearestEndComesFirst) {
  const auto plan = lanes();
  const std::vector<std::size_t> all = {0, 1, 2};
  const RowVisit west = first_visit(*plan, 0, {{-2.0, -1.0}, 0.0}, all);
  EXPECT_EQ(west, (RowVisit{5, false}));
  const RowVisit north_east = first_visit(*plan, 0, {{62.0, 21.0}, 0.0}, all);
  EXPECT_EQ(north_east, (RowVisit{7, true}));
}

TEST(RowOrder, OnlyTheGivenRowsCount) {
  const auto plan = lanes();
  const std::vector<std::size_t> one = {1};
  EXPECT_EQ(first_visit(*plan, 1, {{-2.0, -1.0}, 0.0}, one), (RowVisit{6, false}));
}

}  // namespace
}  // namespace fleetmap::planning
