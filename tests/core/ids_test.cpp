#include "fleetmap/core/ids.hpp"

#include <gtest/gtest.h>

namespace fleetmap {
namespace {

TEST(AgentId, AcceptsOnlyWhatFitsTheWire) {
  for (const char* good : {"r1", "a", "robot-07", "x_y-z012"})
    EXPECT_EQ(AgentId::parse(good).value().str(), good);
  for (const char* bad : {"", "Robot", "a b", "r1/2", "ninechars", "r\n", "\xc3\xa9"}) {
    const auto parsed = AgentId::parse(bad);
    ASSERT_FALSE(parsed) << bad;
    EXPECT_NE(parsed.error().message.find("1 to 8 characters"), std::string::npos);
  }
}

TEST(NodeId, OrdersByAgentThenSequence) {
  const AgentId a = AgentId::parse("a").value();
  const AgentId b = AgentId::parse("b").value();
  EXPECT_LT((NodeId{a, 9}), (NodeId{b, 0}));
  EXPECT_LT((NodeId{a, 9}), (NodeId{a, 10}));
  EXPECT_EQ(to_string(NodeId{b, 17}), "b/17");
}

}  // namespace
}  // namespace fleetmap
