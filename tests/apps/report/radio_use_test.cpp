#include "report/radio_use.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fleetmap::apps {
namespace {

using nlohmann::json;

TEST(RadioUse, OfARunIsByKindOfMessageAndOfAllRobots) {
  const auto uses = radio_uses(json::parse(R"({"links": [
      {"link": "long_range", "topic": "fleetmap/node/r1", "messages": 2, "wire_bytes": 300},
      {"link": "long_range", "topic": "fleetmap/node/r2", "messages": 1, "wire_bytes": 100},
      {"link": "short_range", "topic": "/tf", "messages": 5, "wire_bytes": 9}]})"));
  ASSERT_EQ(uses.size(), 2u);
  EXPECT_EQ(uses.at({"long_range", "node"}).messages, 3u);
  EXPECT_EQ(uses.at({"long_range", "node"}).bytes, 400u);
  EXPECT_EQ(uses.at({"long_range", "node"}).received_bytes, 0u);
}

TEST(RadioUse, OfARobotHasWhatItSentAndReceived) {
  const auto uses = radio_uses(json::parse(R"({"topics": [
      {"link": "short_range", "kind": "cloud", "sent_messages": 2, "sent_bytes": 50, "received_bytes": 70}]})"));
  ASSERT_EQ(uses.size(), 1u);
  const RadioUse& use = uses.begin()->second;
  EXPECT_EQ(use.messages, 2u);
  EXPECT_EQ(use.bytes, 50u);
  EXPECT_EQ(use.received_bytes, 70u);
}

TEST(RadioUse, WhatIsNoReportHasNone) {
  for (const char* text :
       {"[]", "3", "{}", R"({"links": 4})", R"({"topics": {"a": 1}})", R"({"links": [7]})"})
    EXPECT_TRUE(radio_uses(json::parse(text)).empty()) << text;
  const auto odd = radio_uses(json::parse(R"({"topics": [{"link": 4, "kind": "node", "sent_bytes": -1}]})"));
  ASSERT_EQ(odd.size(), 1u);
  EXPECT_EQ(odd.begin()->second.bytes, 0u);
}

}  // namespace
}  // namespace fleetmap::apps
