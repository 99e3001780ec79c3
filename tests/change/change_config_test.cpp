#include "fleetmap/change/change_config.hpp"

#include <gtest/gtest.h>

namespace fleetmap::change {
namespace {

TEST(ChangeConfig, RefusesWhatCannotBe) {
  EXPECT_TRUE(ChangeConfig{}.validate());
  for (double ChangeConfig::*field : {&ChangeConfig::cell_m, &ChangeConfig::tile_m, &ChangeConfig::reach_m}) {
    ChangeConfig config;
    config.*field = 0.0;
    EXPECT_FALSE(config.validate());
  }
  ChangeConfig config;
  config.reach_m = 0.5 * config.cell_m;
  EXPECT_FALSE(config.validate());
  for (std::size_t ChangeConfig::*field : {&ChangeConfig::min_submaps, &ChangeConfig::min_cells}) {
    ChangeConfig none;
    none.*field = 0;
    EXPECT_FALSE(none.validate());
  }
}

}  // namespace
}  // namespace fleetmap::change
