#include "fleetmap/planning/mission/mission_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::planning {
namespace {

using fleetmap::testing::expect_refused;
using fleetmap::testing::kInfinity;
using fleetmap::testing::kNaN;

TEST(MissionConfig, DefaultsAreValid) { EXPECT_TRUE(MissionConfig{}.validate()); }

TEST(MissionConfig, RowsAndSpeedAreBounded) {
  expect_refused(
      MissionConfig{}, [](MissionConfig& c) { c.rows.every = 0; }, "every");
  for (const double wrong : {0.5, -1.0, kNaN<double>})
    expect_refused(
        MissionConfig{}, [&](MissionConfig& c) { c.rows.max_row_length = wrong; }, "max_row_length");
  for (const double good : {0.0, 1.0}) {
    MissionConfig config;
    config.rows.max_row_length = good;
    EXPECT_TRUE(config.validate()) << good;
  }
  expect_refused(MissionConfig{}, &MissionConfig::speed, {0.0, -1.0, kNaN<double>, kInfinity<double>},
                 "speed");
}

TEST(MissionConfig, ItsPartsAreChecked) {
  expect_refused(
      MissionConfig{}, [](MissionConfig& c) { c.division.search_rounds = -1; }, "search_rounds");
  expect_refused(
      MissionConfig{}, [](MissionConfig& c) { c.routes.cell = 0.0; }, "cell");
  expect_refused(
      MissionConfig{}, [](MissionConfig& c) { c.meeting.c_max = 0.0; }, "c_max");
  expect_refused(
      MissionConfig{}, [](MissionConfig& c) { c.executive.row_attempts = 0; }, "row_attempts");
}

}  // namespace
}  // namespace fleetmap::planning
