#include "fleetmap/planning/division/rendezvous.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "fleetmap/planning/mission/fleet_plan.hpp"
#include "fleetmap/planning/mission/mission_complete.hpp"
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
  // Who is done much later is met where it ends.
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

TEST(MissionComplete, NeedsAConnectedFleetWithGoodAlignmentsAndTheSameNodes) {
  const AgentId a = testing::name(0), b = testing::name(1), c = testing::name(2);
  const std::vector<AgentId> fleet = {a, b, c};
  using Pairs = std::vector<PairAlignment>;
  EXPECT_TRUE(mapping_complete(fleet, Pairs{{a, b, 0.3}, {c, b, 0.4}}, true).complete);
  const Completeness unshared = mapping_complete(fleet, Pairs{{a, b, 0.3}, {c, b, 0.4}}, false);
  EXPECT_FALSE(unshared.complete);
  EXPECT_NE(unshared.why_not.find("nodes"), std::string::npos);
  const Completeness apart =
      mapping_complete(fleet, Pairs{{a, b, 0.3}, {c, b, 0.41}, {a, c, std::nan("")}}, true);
  EXPECT_FALSE(apart.complete);
  EXPECT_NE(apart.why_not.find("r3"), std::string::npos);
  EXPECT_FALSE(mapping_complete(fleet, Pairs{{a, b, 0.1}, {c, c, 0.1}, {c, *AgentId::parse("x"), 0.1}}, true)
                   .complete);
  EXPECT_TRUE(mapping_complete(std::vector<AgentId>{a}, Pairs{}, true).complete);
  EXPECT_FALSE(mapping_complete({}, Pairs{}, true).complete);
}

}  // namespace
}  // namespace fleetmap::planning
