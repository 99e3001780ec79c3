// The end of an agent: whatever ends it or its sensors, its robot is told to stand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/driving_twin.hpp"

namespace fleetmap {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

using AgentLifetime = testing::DrivingTwin;

TEST_F(AgentLifetime, WhenTheProcessIsToldToStop) {
  testing::CommandLog r1 = log(1);
  const auto twin = sim();
  const auto process = agent("r1");
  ASSERT_TRUE(r1.hear_until_driving(60s)) << process->output() << twin->output();
  const Stamp event = r1.now();
  process->signal(SIGTERM);
  r1.hear_for(4s);
  r1.expect_stands_since(event);
  EXPECT_EQ(process->wait(), 0) << process->output();
}

TEST_F(AgentLifetime, WhenTheSensorsDie) {
  testing::CommandLog r1 = log(1);
  const auto twin = sim();
  const auto process = agent("r1");
  ASSERT_TRUE(r1.hear_until_driving(60s)) << process->output() << twin->output();
  const Stamp event = r1.now();
  twin->signal(SIGKILL);
  r1.hear_for(3s);
  r1.expect_stands_since(event);
  EXPECT_THAT(process->output(), HasSubstr("r1: stands still: no scan comes"));
}

}  // namespace
}  // namespace fleetmap
