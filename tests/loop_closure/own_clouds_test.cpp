#include "own_clouds.hpp"

#include <gtest/gtest.h>

#include "own_track.hpp"

namespace fleetmap::loop_closure {
namespace {

TEST(OwnClouds, ACloudIsMadeAnewOnceMoreSubmapsLieAround) {
  testing::OwnTrack track;
  const graph::Node first = track.add(0.0);
  registration::SpherizeConfig config;
  config.radius_m = 10.0f;
  OwnClouds clouds(config);
  const auto alone = clouds.of(track.store(), first);
  EXPECT_EQ(clouds.of(track.store(), first), alone);
  ASSERT_TRUE(alone->spherized()) << alone->spherized().error().message;
  track.add(5.0);
  const auto both = clouds.of(track.store(), first);
  ASSERT_NE(both, alone);
  ASSERT_TRUE(both->spherized());
  EXPECT_GT(both->spherized()->points_in, alone->spherized()->points_in);
}

}  // namespace
}  // namespace fleetmap::loop_closure
