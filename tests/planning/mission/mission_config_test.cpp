#include "fleetmap/planning/mission/mission_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::planning {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kInfinity;
using fleetmap::testing::kNaN;

using Config = MissionConfig;

TEST(MissionConfig, DefaultsAreValid) { EXPECT_TRUE(Config{}.validate()); }

TEST(MissionConfig, RowsAndSpeedAreBounded) {
  expect_refused(
      Config{}, [](Config& c) { c.rows.every = 0; }, "every");
  for (const double wrong : {0.5, -1.0, kNaN<double>})
    expect_refused(
        Config{}, [&](Config& c) { c.rows.max_row_length = wrong; }, "max_row_length");
  for (const double good : {0.0, 1.0}) {
    Config config;
    config.rows.max_row_length = good;
    EXPECT_TRUE(config.validate()) << good;
  }
  expect_refused(Config{}, &Config::speed, {0.0, -1.0, kNaN<double>, kInfinity<double>}, "speed");
}

TEST(MissionConfig, ItsPartsAreChecked) {
  expect_refused(
      Config{}, [](Config& c) { c.division.search_rounds = -1; }, "search_rounds");
  expect_refused(
      Config{}, [](Config& c) { c.routes.cell = 0.0; }, "cell");
  expect_refused(
      Config{}, [](Config& c) { c.meeting.c_max = 0.0; }, "c_max");
  expect_refused(
      Config{}, [](Config& c) { c.executive.row_attempts = 0; }, "row_attempts");
}

}  // namespace
}  // namespace fleetmap::planning
