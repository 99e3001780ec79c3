#include "robot/live_bus.hpp"

#include <gtest/gtest.h>

namespace fleetmap::apps {
namespace {

AgentId id(const std::string& name) { return AgentId::parse(name).value(); }

TEST(LiveBus, ANameThatARobotHasIsNumbered) {
  EXPECT_EQ(free_name("operator", {id("r1"), id("r2")}), id("operator"));
  EXPECT_EQ(free_name("operator", {id("operator")}), id("op-1"));
  EXPECT_EQ(free_name("check", {id("check"), id("ch-1"), id("ch-2")}), id("ch-3"));
}

TEST(LiveBus, ABusWithoutProfilesIsRefused) {
  bus::DdsBusConfig config;
  config.agent = id("r1");
  config.qos_directory = "no_such_folder";
  config.long_range.enabled = config.short_range.enabled = false;
  const auto bus = join_dds(config);
  ASSERT_FALSE(bus);
  EXPECT_NE(bus.error().message.find("no_such_folder"), std::string::npos);
}

}  // namespace
}  // namespace fleetmap::apps
