#include "health/silent_topics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fleetmap::apps {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(SilentTopics, AreThoseWithoutAMessageThatAreUsed) {
  agent::PerceptionConfig config;
  config.topics.wheel = "rt/odom";
  EXPECT_THAT(silent_topics(config, {900, 30, 450}), IsEmpty());
  EXPECT_THAT(silent_topics(config, {900, 30, 0}),
              ElementsAre(AllOf(HasSubstr("no sample on rt/odom: is its driver on"),
                                HasSubstr("A robot without it has odometry.use_wheel: false"))));
  EXPECT_THAT(silent_topics(config, {0, 0, 450}),
              ElementsAre(HasSubstr("odometry.use_imu: false"), HasSubstr("gps.use: false")));
  config.odometry_uses_imu = config.odometry_uses_wheel = config.uses_gps = false;
  EXPECT_THAT(silent_topics(config, {}), IsEmpty());
}

}  // namespace
}  // namespace fleetmap::apps
