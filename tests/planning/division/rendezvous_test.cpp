#include "fleetmap/planning/division/rendezvous.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "fleetmap/planning/mission/fleet_plan.hpp"
#include "planning/sites.hpp"

namespace fleetmap::planning {
namespace {

TEST(Rendezvous, OnOpenGroundTwoMeetHalfWay) {
  Mission mission;
  mission.rows = {{0, {{0, 0}, {100, 0}}}};
  const auto planner = *RoutePlanner::create(mission);
  const std::vector<Arrival> arrivals = {{{0, 0}, 10.0, 1.0}, {{100, 0}, 10.0, 1.0}};
  const auto meeting = *meeting_place(planner, arrivals, {});
  EXPECT_NEAR(meeting.place.x(), 50.0, 1.0);
  EXPECT_NEAR(meeting.latest, 60.0, 1.0);
  // A robot that ends much later is met where it ends.
  const std::vector<Arrival> late = {{{0, 0}, 10.0, 1.0}, {{100, 0}, 500.0, 1.0}};
  EXPECT_NEAR(meeting_place(planner, late, {})->latest, 500.0, 1.0);
}

TEST(Rendezvous, PlacesAreApartClearAndWithinReach) {
  testing::SiteSpec spec;
  for (int robots = 2; robots <= 5; ++robots) {
    const auto plan = *plan_fleet(testing::site(spec), testing::fleet(robots), {});
    ASSERT_EQ(plan->meeting->positions.size(), static_cast<std::size_t>(robots));
    double latest = 0.0;
    for (int a = 0; a < robots; ++a) {
      const auto& p = plan->meeting->positions[static_cast<std::size_t>(a)];
      EXPECT_TRUE(plan->planner.clear(p));
      latest = std::max(latest, plan->meeting->arrivals[static_cast<std::size_t>(a)]);
      for (int b = 0; b < a; ++b) {
        const double apart = (p - plan->meeting->positions[static_cast<std::size_t>(b)]).norm();
        EXPECT_GE(apart, 0.99);
        EXPECT_LE(apart, 90.0);
      }
    }
    EXPECT_EQ(latest, plan->meeting->latest);
    EXPECT_EQ(plan->division.makespan, latest);
  }
}

TEST(Rendezvous, ThereIsNoneAcrossAWallWithoutGate) {
  Mission mission;
  mission.rows = {{0, {{0, 0}, {10, 0}}}};
  mission.boundary = KeepOut{{-50, -50}, {50, -50}, {50, 50}, {-50, 50}};
  mission.keep_out = {{{20, -60}, {22, -60}, {22, 60}, {20, 60}}};
  const auto planner = *RoutePlanner::create(mission);
  const std::vector<Arrival> arrivals = {{{0, 0}, 0.0, 1.0}, {{40, 0}, 0.0, 1.0}};
  EXPECT_FALSE(meeting_place(planner, arrivals, {}));
  EXPECT_FALSE(meeting_place(planner, {}, {}));
}

}  // namespace
}  // namespace fleetmap::planning
