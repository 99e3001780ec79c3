#include "fleetmap/loop_closure/map_session_config.hpp"

#include <gtest/gtest.h>

namespace fleetmap::loop_closure {
namespace {

TEST(MapSessionConfig, ChecksAllItsParts) {
  EXPECT_TRUE(MapSessionConfig{}.validate());
  MapSessionConfig config;
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
