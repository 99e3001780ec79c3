#include "robot/output_recording.hpp"

#include <gtest/gtest.h>

#include <map>

#include "agent/lapping_robot.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

/// A recording must not change the run that it is of.
TEST(OutputRecording, WritesEveryTopicAndLeavesTheRobotAsItIs) {
  const testing::TemporaryFolder folder;
  std::vector<std::map<NodeId, graph::Node>> nodes;
  std::map<std::string, int> written;
  for (const bool recorded : {false, true}) {
    testing::LappingRobot::Options options;
    options.columns = 400;
    options.folder = folder.path() / (recorded ? "recorded" : "alone");
    testing::LappingRobot robot(options);
    std::unique_ptr<OutputRecording> recording;
    if (recorded) {
      recording = std::make_unique<OutputRecording>(
          robot.agent(), robot.bus(), ros_output::RosOutputConfig{},
          [&](const bus::Topic& topic, const Bytes&) { ++written[topic.name]; });
    }
    robot.run_for(25.0);
    nodes.push_back(robot.agent().store().nodes());
  }
  for (const bus::Topic& topic : ros_codec::topics::outputs())
    EXPECT_GT(written[topic.name], 0) << topic.name;
  ASSERT_EQ(nodes[0].size(), nodes[1].size());
  for (const auto& [id, node] : nodes[0]) {
    const auto other =
        std::ranges::find(nodes[1], node.stamp, [](const auto& entry) { return entry.second.stamp; });
    ASSERT_NE(other, nodes[1].end());
    EXPECT_EQ(other->second.submap_hash, node.submap_hash);
    EXPECT_EQ(other->second.T_odom_base.matrix(), node.T_odom_base.matrix());
  }
}

}  // namespace
}  // namespace fleetmap::apps
