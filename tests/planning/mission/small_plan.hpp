#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "fleetmap/planning/mission/fleet_plan.hpp"
#include "planning/sites.hpp"

namespace fleetmap::planning::testing {

inline Stamp at(double seconds) { return Stamp{} + from_seconds(seconds); }

/// A farm of 80 m x 80 m, divided among `robots`.
inline std::shared_ptr<const FleetPlan> plan_for(int robots) {
  SiteSpec spec;
  spec.width = spec.depth = 80.0;
  MissionConfig config;
  config.division.search_rounds = 10;
  auto plan = plan_fleet(site(spec), fleet(robots), config);
  EXPECT_TRUE(plan) << (plan ? "" : plan.error().message);
  return *plan;
}

}  // namespace fleetmap::planning::testing
