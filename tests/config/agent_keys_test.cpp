#include "agent_keys.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fleetmap::config {
namespace {

TEST(AgentKeys, AreThoseOfAgentRecordingAndTwinAndNoneOfTheFleet) {
  const std::set<std::string> keys = agent_keys();
  for (const char* key : {"id", "mode", "directory", "lidar", "odometry", "nodes", "recording", "robot"})
    EXPECT_TRUE(keys.contains(key)) << key;
  for (const char* key : {"agents", "defaults", "world", "network", "field", "mission"})
    EXPECT_FALSE(keys.contains(key)) << key;
}

TEST(AgentKeys, OfAFleetsFileAreKeptWithTheirValues) {
  const YAML::Node root = YAML::Load("{agents: [{id: a}], lidar: {model: vlp16}, network: {}, mode: paper}");
  const YAML::Node kept = agent_keys_of(root, {"lidar", "mode", "nodes"});
  EXPECT_EQ(kept.size(), 2u);
  EXPECT_EQ(kept["lidar"]["model"].as<std::string>(), "vlp16");
  EXPECT_EQ(kept["mode"].as<std::string>(), "paper");
  EXPECT_EQ(root.size(), 4u);
  EXPECT_TRUE(agent_keys_of(YAML::Load("{}"), {"lidar"}).IsMap());
}

}  // namespace
}  // namespace fleetmap::config
