#include "rounding.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "fleetmap/fleet_codec/node.hpp"
#include "fleetmap_long_range.h"
#include "random_messages.hpp"

namespace fleetmap::fleet_codec {
namespace {

using ::testing::HasSubstr;

graph::Node node_at(std::int64_t seconds) {
  graph::Node node;
  node.id = testing::node_id("r1", 1);
  node.stamp = stamp_from_ns(seconds * 1'000'000'000);
  node.odom_covariance = Matrix6d::Identity();
  node.submap_bytes = 1;
  return node;
}

constexpr std::int64_t kSecond = 1'000'000'000;

Result<graph::Node> rounded_by(Result<graph::Node> (*read)(const msg::Node&), const graph::Node& node) {
  return rounded<msg::Node>(node, "Node", read);
}

TEST(Rounding, EndsWhenTheEncodingStaysTheSame) {
  const auto result = rounded_by(
      [](const msg::Node& message) -> Result<graph::Node> {
        return node_at(std::min<std::int64_t>(message.stamp() / kSecond + 1, 2));
      },
      node_at(0));
  ASSERT_TRUE(result);
  EXPECT_EQ(to_ns(result->stamp), 2 * kSecond);
}

TEST(Rounding, FailsForNumbersThatChangeWithEachRound) {
  const auto result = rounded_by(
      [](const msg::Node& message) -> Result<graph::Node> { return node_at(message.stamp() / kSecond + 1); },
      node_at(0));
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().message, HasSubstr("change with each rounding"));
}

TEST(Rounding, PassesOnTheErrorOfTheReader) {
  const auto result =
      rounded_by([](const msg::Node&) -> Result<graph::Node> { return failure("no pose"); }, node_at(0));
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().message, "no pose");
}

TEST(Rounding, LeavesTheSignatureOut) {
  graph::Node node = node_at(5);
  node.signature.emplace();
  const auto result = rounded_by([](const msg::Node&) -> Result<graph::Node> { return node_at(5); }, node);
  ASSERT_TRUE(result);
  EXPECT_FALSE(result->signature);
}

}  // namespace
}  // namespace fleetmap::fleet_codec
