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

TEST(NodeId, NamesAreReadAsTheyAreWritten) {
  const auto agent = [](const char* name) { return AgentId::parse(name).value(); };
  for (const NodeId& id :
       {NodeId{agent("r1"), 0}, NodeId{agent("r10"), 65'535}, NodeId{agent("a-b_c"), first_seq(4711) + 17},
        NodeId{agent("r1"), first_seq(65'534)}}) {
    const auto parsed = parse_node_id(to_string(id));
    ASSERT_TRUE(parsed) << to_string(id);
    EXPECT_EQ(*parsed, id);
  }
  for (const char* wrong :
       {"", "r1", "r1/", "/3", "r1/-1", "r1/65536", "r1#/3", "r1#65536/3", "R 1/3", "r1/3x", "r1#2#3/4"})
    EXPECT_FALSE(parse_node_id(wrong)) << wrong;
}

}  // namespace
}  // namespace fleetmap
