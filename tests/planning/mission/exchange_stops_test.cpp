#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "planning/mission/virtual_fleet.hpp"
#include "planning/sites.hpp"

namespace fleetmap::planning {
namespace {

using testing::VirtualFleet;

constexpr double kLongLimit = 9000.0;
constexpr double kLowLoss = 0.2;

/// A triangular farm, a slow robot among fast ones, heavy maps over a slow link.
MissionConfig slow_link_config(DivisionMethod method = DivisionMethod::kEnergy) {
  MissionConfig config;
  config.division.method = method;
  config.division.search_rounds = 30;
  config.meeting.bandwidth = 2e6;
  config.meeting.map_bytes_per_metre = 60e3;
  return config;
}

std::shared_ptr<const FleetPlan> plan_by(DivisionMethod method = DivisionMethod::kEnergy) {
  testing::SiteSpec spec;
  spec.width = spec.depth = 300.0;
  spec.taper = 0.9;
  spec.every = 3;
  auto plan = plan_fleet(testing::site(spec), testing::fleet(3, true), slow_link_config(method));
  EXPECT_TRUE(plan) << (plan ? "" : plan.error().message);
  return *plan;
}

/// Made once: planning takes most of a test's time.
const std::shared_ptr<const FleetPlan>& with_stops() {
  static const auto plan = plan_by();
  return plan;
}

std::shared_ptr<const FleetPlan> without_stops(const FleetPlan& plan) {
  auto other = std::make_shared<FleetPlan>(plan);
  other->exchange->stops.clear();
  return other;
}

VirtualFleet fleet_on(const std::shared_ptr<const FleetPlan>& plan, std::uint64_t seed = 3) {
  VirtualFleet fleet(plan, kLowLoss, seed);
  const RendezvousConfig& link = plan->config.meeting;
  fleet.radio.emplace(plan->fleet.size(), link.bandwidth * link.efficiency, link.map_bytes_per_metre,
                      link.c_max);
  return fleet;
}

std::size_t kept(const VirtualFleet& fleet) {
  std::size_t sum = 0;
  for (const auto& robot : fleet.robots) {
    if (robot.executive) sum += robot.executive->status().stops_kept;
  }
  return sum;
}
std::size_t dropped(const VirtualFleet& fleet) {
  std::size_t sum = 0;
  for (const auto& robot : fleet.robots) {
    if (robot.executive) sum += robot.executive->status().stops_dropped;
  }
  return sum;
}

TEST(ExchangeStops, MakeTheFleetCompleteEarlier) {
  ASSERT_FALSE(with_stops()->exchange->stops.empty());
  VirtualFleet stopping = fleet_on(with_stops());
  const double with = stopping.run(kLongLimit);
  VirtualFleet passing = fleet_on(without_stops(*with_stops()));
  const double without = passing.run(kLongLimit);
  EXPECT_EQ(stopping.rows_driven(), with_stops()->mission.rows.size());
  EXPECT_TRUE(stopping.radio->all_hold_all());
  EXPECT_TRUE(passing.radio->all_hold_all());
  EXPECT_EQ(kept(stopping), 2 * with_stops()->exchange->stops.size());
  EXPECT_EQ(dropped(stopping), 0u);
  EXPECT_EQ(kept(passing), 0u);
  const double promised =
      without_stops(*with_stops())->exchange->completion_without_stops - with_stops()->completion;
  EXPECT_LT(with, without - 0.5 * promised) << "promised: " << promised;
}

/// Two who are at the first stop of the plan, or soon will be.
const Detour& first_stop() {
  const auto& stops = with_stops()->exchange->stops;
  return *std::ranges::min_element(stops, {}, &Detour::leave);
}

TEST(ExchangeStops, NobodyWaitsForOneWhoIsLost) {
  VirtualFleet fleet = fleet_on(with_stops());
  const Detour& stop = first_stop();
  const double before = 0.5 * std::max(stop.parts[0].arrival, stop.parts[1].arrival);
  fleet.run(kLongLimit, [&] {
    if (std::abs(fleet.now - before) < 0.6) fleet.kill(stop.parts[1].robot);
  });
  EXPECT_LT(fleet.now, kLongLimit);
  EXPECT_EQ(fleet.rows_driven(), fleet.plan->mission.rows.size());
  EXPECT_GE(fleet.robots[stop.parts[0].robot].executive->status().stops_dropped, 1u);
  EXPECT_EQ(fleet.robots[stop.parts[0].robot].state, MissionState::kDone);
}

TEST(ExchangeStops, NobodyWaitsForOneWithoutBattery) {
  VirtualFleet fleet = fleet_on(with_stops());
  const Detour& stop = first_stop();
  const std::size_t weak = stop.parts[0].robot;
  fleet.run(kLongLimit, [&] {
    if (fleet.now == 60.0) fleet.robots[weak].battery = 0.05;
  });
  EXPECT_LT(fleet.now, kLongLimit);
  EXPECT_EQ(fleet.rows_driven(), fleet.plan->mission.rows.size());
  EXPECT_GE(fleet.robots[weak].executive->status().stops_dropped, 1u);
  EXPECT_GE(fleet.robots[stop.parts[1].robot].executive->status().stops_dropped, 1u);
}

TEST(ExchangeStops, RobotThatWaitsInVainAtAStopGoesOn) {
  // The partner says that it drives its rows, but a gate keeps it.
  VirtualFleet fleet = fleet_on(with_stops());
  const Detour& stop = first_stop();
  const std::size_t late = stop.parts[0].robot;
  const std::size_t waits = stop.parts[1].robot;
  const double speed = fleet.robots[late].speed;
  fleet.run(kLongLimit,
            [&] { fleet.robots[late].speed = fleet.now < 60.0 || fleet.now > 1500.0 ? speed : 0.02; });
  EXPECT_LT(fleet.now, kLongLimit);
  EXPECT_EQ(fleet.rows_driven(), fleet.plan->mission.rows.size());
  EXPECT_GE(fleet.robots[waits].executive->status().stops_dropped, 1u);
}

TEST(ExchangeStops, ARadioThatNeverBringsAnythingHoldsNobody) {
  VirtualFleet fleet = fleet_on(with_stops());
  fleet.radio.emplace(fleet.plan->fleet.size(), 1.0, 60e3, 90.0);
  fleet.run(3.0 * kLongLimit);
  EXPECT_LT(fleet.now, 3.0 * kLongLimit);
  EXPECT_EQ(fleet.rows_driven(), fleet.plan->mission.rows.size());
  EXPECT_EQ(kept(fleet), 0u);
}

TEST(ExchangeStops, ThereAreNoneInTheOtherDivisions) {
  for (const DivisionMethod method : {DivisionMethod::kBalanced, DivisionMethod::kUniform}) {
    const auto plan = plan_by(method);
    EXPECT_TRUE(plan->exchange->stops.empty());
    EXPECT_EQ(plan->completion, plan->exchange->completion_without_stops);
  }
}

}  // namespace
}  // namespace fleetmap::planning
