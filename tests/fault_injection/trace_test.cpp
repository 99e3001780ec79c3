#include "trace.hpp"

#include <gtest/gtest.h>

#include <chrono>

namespace fleetmap::fault_injection {
namespace {

using namespace std::chrono_literals;

TEST(Trace, LinesCarryTheTimeOfTheRun) {
  Trace trace(true);
  trace.add(1500ms, "r1 starts");
  EXPECT_EQ(trace.take(), std::vector<std::string>{"     1.50 s  r1 starts"});
  EXPECT_TRUE(trace.take().empty());
}

TEST(Trace, IsEmptyUnlessItIsOn) {
  Trace trace(false);
  trace.add(1500ms, "r1 starts");
  EXPECT_TRUE(trace.take().empty());
}

TEST(Trace, EventsThatExplainAFailureHaveALine) {
  const AgentId r2 = AgentId::parse("r2").value();
  EXPECT_EQ(trace_line(exchange::StoreFailed{{"the disk is full"}}), "the disk is full");
  EXPECT_EQ(trace_line(exchange::OwnItemsElsewhere{r2, 1, 0}), "r2 holds own items that the store lacks");
  EXPECT_EQ(trace_line(exchange::ItemConflict{{r2, 9}, false, messages::Reach::kLongRange, false, {}}),
            "conflict node r2/9");
  EXPECT_EQ(trace_line(exchange::MapComplete{}), std::nullopt);
}

TEST(Trace, NamesTheItemThatAnAttackerSends) {
  graph::Node node;
  node.id = {AgentId::parse("r2").value(), 9};
  EXPECT_EQ(trace_line(messages::Message(node)), "node r2/9");
  EXPECT_EQ(trace_line(messages::Message(messages::Digest{})).substr(0, 8), "message ");
}

}  // namespace
}  // namespace fleetmap::fault_injection
