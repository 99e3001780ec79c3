#include "fleetmap/graph/frame_name.hpp"

#include <gtest/gtest.h>

#include <array>

namespace fleetmap::graph {
namespace {

TEST(FrameName, TheSessionIsNamedWhereThereIsOne) {
  const AgentId agent = AgentId::parse("robot-08").value();
  EXPECT_EQ(to_string(FrameId{agent, 0}), "robot-08");
  EXPECT_EQ(to_string(FrameId{agent, 4711}), "robot-08#4711");
  EXPECT_EQ(to_string(FrameId{agent, 65534}), "robot-08#65534");
}

/// So that files of frames and of nodes can be compared by eye.
TEST(FrameName, IsTheFirstPartOfTheNamesOfItsNodes) {
  const AgentId agent = AgentId::parse("r1").value();
  for (const std::uint16_t session : std::array<std::uint16_t, 3>{0, 1, 4711}) {
    Node node;
    node.id = {agent, first_seq(session) + 17};
    node.session = session;
    EXPECT_EQ(to_string(node.frame()) + "/17", fleetmap::to_string(node.id));
  }
}

}  // namespace
}  // namespace fleetmap::graph
