#include "radio_history_json.hpp"

#include <gtest/gtest.h>

namespace fleetmap::monitor {
namespace {

constexpr Stamp at(int s) { return stamp_from_ns(1'000'000'000LL * s); }

/// From 100 s to 103 s.
RadioHistory two_robots() {
  RadioHistory history;
  history.traces = {*AgentId::parse("r1")};
  history.begin = at(100);
  history.steps = 3;
  HeardLink& link = history.links.emplace_back();
  link.from = *AgentId::parse("r2");
  link.to = *AgentId::parse("r1");
  link.link = "long_range";
  link.bytes = 300.2;
  link.messages = 4.0;
  link.loss = 0.123456;
  link.received = {100.4, 0.0, 200.0};
  link.loss_in = {0.126, std::nullopt, 1.0};
  history.kinds.push_back({"long_range", "node", 10, 20});
  return history;
}

TEST(RadioHistoryJson, HasLinksByStepAndKinds) {
  const auto json = radio_history_json(two_robots(), at(98), at(200));
  EXPECT_EQ(json["begin_s"], 2.0);
  EXPECT_EQ(json["steps"], 3);
  EXPECT_EQ(json["traces"].dump(), R"(["r1"])");
  const auto& link = json["links"][0];
  EXPECT_EQ(link["from"], "r2");
  EXPECT_EQ(link["bytes"], 300.0);
  EXPECT_EQ(link["loss"], 0.1235);
  EXPECT_TRUE(link["delay_s"].is_null());
  EXPECT_EQ(link["received"].dump(), "[100.0,0.0,200.0]");
  EXPECT_EQ(link["loss_in"].dump(), "[0.126,null,1.0]");
  EXPECT_EQ(json["kinds"].dump(), R"([{"kind":"node","link":"long_range","received":20,"sent":10}])");
}

TEST(RadioHistoryJson, AtAnotherTimeThanTheNodesHasNoBeginAmongThem) {
  EXPECT_TRUE(radio_history_json(two_robots(), at(103), at(200)).contains("begin_s"));
  EXPECT_FALSE(radio_history_json(two_robots(), at(104), at(200)).contains("begin_s")) << "over before";
  EXPECT_TRUE(radio_history_json(two_robots(), at(0), at(100)).contains("begin_s"));
  EXPECT_FALSE(radio_history_json(two_robots(), at(0), at(99)).contains("begin_s")) << "of a later day";
}

TEST(RadioHistoryJson, IsNullWhereNoFileTellsAnything) {
  EXPECT_TRUE(radio_history_json({}, at(0), at(9)).is_null());
}

}  // namespace
}  // namespace fleetmap::monitor
