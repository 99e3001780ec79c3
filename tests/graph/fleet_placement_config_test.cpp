#include "fleetmap/graph/fleet_placement_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::graph {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

using Config = FleetPlacementConfig;

TEST(FleetPlacementConfig, DefaultsAreValid) { EXPECT_TRUE(Config{}.validate()); }

TEST(FleetPlacementConfig, WhatWeightsIsPositive) {
  struct Field {
    double Config::*value;
    const char* name;
  };
  for (const Field& field : {Field{&Config::gps_correlation_time, "gps_correlation_time"},
                             {&Config::window_m, "window_m"},
                             {&Config::alignment_floor_m, "alignment_floor_m"},
                             {&Config::alignment_floor_rad, "alignment_floor_rad"}}) {
    expect_accepted(Config{}, field.value, {1e-9, 1e9});
    expect_refused(Config{}, field.value, {0.0, -1.0, kNaN<double>}, field.name);
  }
}

TEST(FleetPlacementConfig, BothPartsOfTheErrorOfGRemain) {
  expect_accepted(Config{}, &Config::gps_drift_share, {0.001, 0.999});
  expect_refused(Config{}, &Config::gps_drift_share, {0.0, 1.0, -0.1, 1.1, kNaN<double>}, "gps_drift_share");
}

}  // namespace
}  // namespace fleetmap::graph
