#include "fleetmap/fault_injection/scenario.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace fleetmap::fault_injection {
namespace {

constexpr std::uint64_t kSeeds = 1500;

ScenarioConfig config(const char* kinds = "all") {
  ScenarioConfig config;
  config.kinds = parse_fault_kinds(kinds).value();
  return config;
}

/// Bounds of the value of a fault of this kind.
std::pair<double, double> bounds(FaultKind kind) {
  switch (kind) {
    case FaultKind::kLoss:
      return {0.05, 0.6};
    case FaultKind::kDelay:
      return {0.1, 10.0};
    case FaultKind::kDuplication:
      return {0.05, 0.5};
    case FaultKind::kOldStore:
      return {2.0, 90.0};
    case FaultKind::kDamagedStore:
      return {0.0, 1.0};
    case FaultKind::kClockStep:
      return {-7200.0, 7200.0};
    case FaultKind::kManyStarts:
      return {2.0, 400.0};
    case FaultKind::kStranger:
    case FaultKind::kForged:
      return {0.2, 10.0};
    default:
      return {0.0, 0.0};
  }
}

void expect_sound(const Fault& fault, const Scenario& scenario) {
  EXPECT_GE(fault.begin, Duration::zero());
  EXPECT_LE(fault.begin, scenario.mapping * 95 / 100);
  EXPECT_GE(fault.length, std::chrono::seconds(1));
  EXPECT_LE(fault.length, scenario.mapping / 2);
  EXPECT_GE(fault.value, bounds(fault.kind).first);
  EXPECT_LE(fault.value, bounds(fault.kind).second);
  const std::set<std::size_t> robots(fault.robots.begin(), fault.robots.end());
  EXPECT_EQ(robots.size(), fault.robots.size()) << "a robot is named twice";
  EXPECT_TRUE(robots.empty() || *robots.rbegin() < scenario.robots);
  if (impairs_links(fault.kind)) {
    EXPECT_TRUE(fault.radio || fault.short_range) << "it would do nothing";
  }
  if (fault.kind == FaultKind::kOneWay) {
    EXPECT_EQ(robots.size(), 2u);
  }
  if (fault.kind == FaultKind::kPartition) {
    EXPECT_GE(robots.size(), 1u);
    EXPECT_LT(robots.size(), scenario.robots) << "somebody is on the other side";
  }
  if (fault.kind == FaultKind::kCrash || fault.kind == FaultKind::kLiar) {
    EXPECT_EQ(robots.size(), 1u);
  }
  if (fault.kind == FaultKind::kStranger) {
    EXPECT_TRUE(robots.empty());
  }
}

TEST(Scenario, IsWithinItsConfiguration) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Scenario scenario = make_scenario(seed, config());
    EXPECT_EQ(scenario.seed, seed);
    EXPECT_EQ(scenario.mapping, config().mapping);
    EXPECT_GE(scenario.robots, 3u);
    EXPECT_LE(scenario.robots, 10u);
    EXPECT_GE(scenario.faults.size(), 1u);
    EXPECT_LE(scenario.faults.size(), 12u);
    EXPECT_TRUE(std::ranges::is_sorted(scenario.faults, {}, &Fault::begin));
    for (const Fault& fault : scenario.faults) expect_sound(fault, scenario);
  }
}

TEST(Scenario, TogetherReachAllThatTheyMay) {
  std::map<FaultKind, int> kinds;
  std::set<std::size_t> robots, counts;
  int radio_only = 0, short_only = 0, both = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Scenario scenario = make_scenario(seed, config());
    robots.insert(scenario.robots);
    counts.insert(scenario.faults.size());
    for (const Fault& fault : scenario.faults) {
      ++kinds[fault.kind];
      if (!impairs_links(fault.kind)) continue;
      radio_only += !fault.short_range;
      short_only += !fault.radio;
      both += fault.radio && fault.short_range;
    }
  }
  EXPECT_EQ(robots.size(), 8u);
  EXPECT_EQ(counts.size(), 12u);
  EXPECT_EQ(kinds.size(), kFaultKinds);
  for (const auto& [kind, count] : kinds) EXPECT_GT(count, 400) << to_string(kind);  // of 540 on average
  const double links = radio_only + short_only + both;
  EXPECT_NEAR(radio_only / links, 0.3, 0.04);
  EXPECT_NEAR(short_only / links, 0.3, 0.04);
}

TEST(Scenario, HasFaultsOfTheKindsThatAreAskedForAndNoneWithoutAny) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    for (const Fault& fault : make_scenario(seed, config("crash,liar")).faults)
      EXPECT_TRUE(fault.kind == FaultKind::kCrash || fault.kind == FaultKind::kLiar);
    EXPECT_TRUE(make_scenario(seed, config("")).faults.empty());
  }
  ScenarioConfig four = config("loss");
  four.min_robots = four.max_robots = 4;
  EXPECT_EQ(make_scenario(1, four).robots, 4u);
}

TEST(Scenario, OneMemberAtMostIsCompromised) {
  std::size_t several = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    std::set<std::size_t> compromised;
    const Scenario scenario = make_scenario(seed, config("compromised"));
    for (const Fault& fault : scenario.faults) compromised.insert(fault.robots.begin(), fault.robots.end());
    EXPECT_EQ(compromised.size(), 1u);
    several += scenario.faults.size() > 1;
  }
  EXPECT_GT(several, 50u);
}

TEST(Scenario, FollowsFromItsSeed) {
  const auto text = [](std::uint64_t seed) {
    const Scenario scenario = make_scenario(seed, config());
    std::string all = std::to_string(scenario.robots);
    for (const Fault& fault : scenario.faults) all += "; " + to_string(fault);
    return all;
  };
  EXPECT_EQ(text(8), text(8));
  EXPECT_NE(text(8), text(9));
}

}  // namespace
}  // namespace fleetmap::fault_injection
