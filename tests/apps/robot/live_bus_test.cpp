#include "robot/live_bus.hpp"

#include <gtest/gtest.h>

#include "store/items.hpp"

namespace fleetmap::apps {
namespace {

TEST(LiveBus, ANameThatARobotHasIsNumbered) {
  EXPECT_EQ(free_name("operator", {testing::agent("r1"), testing::agent("r2")}), testing::agent("operator"));
  EXPECT_EQ(free_name("operator", {testing::agent("operator")}), testing::agent("op-1"));
  EXPECT_EQ(free_name("check", {testing::agent("check"), testing::agent("ch-1"), testing::agent("ch-2")}),
            testing::agent("ch-3"));
}

TEST(LiveBus, ABusWithoutProfilesIsRefused) {
  bus::DdsBusConfig config;
  config.agent = testing::agent("r1");
  config.qos_directory = "no_such_folder";
  config.long_range.enabled = config.short_range.enabled = false;
  const auto bus = join_dds(config);
  ASSERT_FALSE(bus);
  EXPECT_NE(bus.error().message.find("no_such_folder"), std::string::npos);
}

}  // namespace
}  // namespace fleetmap::apps
