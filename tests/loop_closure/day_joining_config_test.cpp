#include "fleetmap/loop_closure/day_joining_config.hpp"

#include <gtest/gtest.h>

namespace fleetmap::loop_closure {
namespace {

TEST(DayJoiningConfig, ChecksAllItsParts) {
  EXPECT_TRUE(DayJoiningConfig{}.validate());
  DayJoiningConfig config;
  config.candidates.spacing_m = -1.0;
  EXPECT_FALSE(config.validate());
  config = {};
  config.spherize.radius_m = -1.0f;
  EXPECT_FALSE(config.validate());
  config = {};
  config.registration.voxel_m = 0.0f;
  EXPECT_FALSE(config.validate());
}

}  // namespace
}  // namespace fleetmap::loop_closure
