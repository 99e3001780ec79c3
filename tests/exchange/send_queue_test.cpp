#include "fleetmap/exchange/send_queue.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <random>

#include "cloud_transfer.hpp"
#include "exchange/robots.hpp"
#include "exchange/sim_fleet.hpp"

namespace fleetmap::exchange {
namespace {

using messages::CloudRequest;
using messages::Digest;
using messages::Hold;
using testing::agent;

const std::vector<AgentId> kOne = {kPeer};
const std::vector<AgentId> kFour = {agent("r2"), agent("r3"), agent("r4"), agent("r5")};

graph::Node node(std::uint32_t seq) { return testing::make_node(kSelf, seq, Bytes{}); }
const std::size_t kNodeBytes = testing::payload_size(node(0));

TEST(SendQueue, sends_small_messages_before_clouds_that_wait_longer) {
  LongRangeConfig config;
  config.pace.burst_seconds = 0.5;
  SendQueue queue(config, kOne, testing::payload_size);
  for (auto& fragment : split_cloud(kSelf, kPeer, {kSelf, 0}, Bytes(25'000, 1)))
    queue.push(Priority::kCloud, fragment);
  queue.push(Priority::kState, Digest{kSelf, {}, {}});
  queue.push(Priority::kNews, node(1));
  queue.push(Priority::kControl, CloudRequest{kSelf, kPeer, {kPeer, 3}, {}});
  const auto out = queue.take(kStart);
  ASSERT_GE(out.size(), 4u);
  EXPECT_TRUE(std::holds_alternative<CloudRequest>(out[0].message));
  EXPECT_EQ(out[0].to, kPeer);
  EXPECT_TRUE(std::holds_alternative<graph::Node>(out[1].message));
  EXPECT_EQ(out[1].to, kPeer) << "the only one";
  EXPECT_TRUE(std::holds_alternative<Digest>(out[2].message));
  EXPECT_TRUE(std::holds_alternative<CloudFragment>(out[3].message));
  // The bucket is empty but for the reserve, so a small message need not wait for the clouds.
  queue.push(Priority::kNews, node(2));
  EXPECT_EQ(queue.take(kStart).size(), 1u);
}

TEST(SendQueue, replaces_what_is_stale_and_counts_what_it_drops) {
  LongRangeConfig config;
  config.max_small = 3;
  SendQueue queue(config, kOne, testing::payload_size);
  AgentStatus status;
  for (std::uint32_t k = 0; k < 5; ++k) {
    status.nodes = k;
    queue.push(Priority::kState, status);
  }
  EXPECT_EQ(queue.size(Priority::kState), 1u);
  EXPECT_EQ(queue.stats().superseded, 4u);
  EXPECT_EQ(queue.backlog_bytes(), testing::payload_size(AgentStatus{}) + config.overhead_bytes);
  for (std::uint32_t k = 0; k < 5; ++k) queue.push(Priority::kNews, node(k));
  EXPECT_EQ(queue.stats().dropped[static_cast<std::size_t>(Priority::kNews)], 2u);
  const auto out = queue.take(kStart);
  ASSERT_EQ(out.size(), 4u);
  EXPECT_EQ(std::get<graph::Node>(out[0].message).id.seq, 2u);
  EXPECT_EQ(std::get<AgentStatus>(out[3].message).nodes, 4u);
  EXPECT_TRUE(queue.empty());
  EXPECT_EQ(queue.backlog_bytes(), 0u);
}

TEST(SendQueue, cancels_the_rest_of_one_cloud_only) {
  SendQueue queue({}, kOne, testing::payload_size);
  for (const std::uint32_t seq : {0u, 1u}) {
    for (auto& f : split_cloud(kSelf, kPeer, {kSelf, seq}, Bytes(25'000, 1))) queue.push(Priority::kCloud, f);
  }
  EXPECT_EQ(queue.size(Priority::kCloud), 46u);
  EXPECT_EQ(queue.cancel_cloud(kPeer, {kSelf, 1}), 23u);
  EXPECT_EQ(queue.cancel_cloud(agent("r3"), {kSelf, 0}), 0u);
  EXPECT_EQ(queue.size(Priority::kCloud), 23u);
}

TEST(SendQueue, sends_first_the_cloud_that_is_worth_most_a_byte) {
  LongRangeConfig config;
  config.max_fragments = 30;
  SendQueue queue(config, kOne, testing::payload_size);
  const auto push = [&](std::uint32_t seq, std::size_t bytes, float information) {
    for (auto& f : split_cloud(kSelf, kPeer, {kSelf, seq}, Bytes(bytes, 1)))
      queue.push_fragment(f, information);
  };
  push(0, 22'000, 1.0f);
  push(1, 22'000, 2.0f);
  EXPECT_EQ(queue.size(Priority::kCloud), 30u) << "of 40";
  push(2, 2'200, 0.5f);
  std::vector<std::uint32_t> order;
  for (int k = 0; !queue.empty(); ++k) {
    for (const Outgoing& outgoing : queue.take(kStart + k * std::chrono::milliseconds(100)))
      order.push_back(std::get<CloudFragment>(outgoing.message).node.seq);
  }
  ASSERT_EQ(order.size(), 30u);
  EXPECT_EQ(order[0], 2u) << "little, but cheap";
  EXPECT_EQ(order[2], 1u);
  EXPECT_EQ(order[21], 1u);
  EXPECT_EQ(order[22], 0u) << "its last pieces gave way";
}

TEST(SendQueue, counts_every_copy_and_header) {
  LongRangeConfig config;
  config.fleet_bytes_per_second = 20'000;
  config.overhead_bytes = 160;
  SendQueue queue(config, kFour, testing::payload_size);
  EXPECT_EQ(queue.wire_bytes(node(0), std::nullopt), 4u * (kNodeBytes + 160u));
  EXPECT_EQ(queue.wire_bytes(node(0), kPeer), kNodeBytes + 160u);
  EXPECT_DOUBLE_EQ(queue.share_bytes_per_second(), 4000.0);
  config.deliver_to_one = false;
  EXPECT_EQ(SendQueue(config, kFour, testing::payload_size).wire_bytes(node(0), kPeer),
            4u * (kNodeBytes + 160u));
  config.multicast = true;
  EXPECT_EQ(SendQueue(config, kFour, testing::payload_size).wire_bytes(node(0), std::nullopt),
            kNodeBytes + 160u);
}

TEST(SendQueue, tells_one_robot_after_the_other_and_near_ones_by_another_link) {
  LongRangeConfig config;
  config.pace = {.burst_seconds = 0.0, .min_burst_bytes = 430.0};  // one datagram at a time
  SendQueue queue(config, kFour, testing::payload_size);
  queue.push(Priority::kNews, node(0));
  EXPECT_EQ(queue.backlog_bytes(), 4u * (kNodeBytes + config.overhead_bytes));
  std::vector<AgentId> told;
  for (const Outgoing& outgoing : queue.take(kStart)) told.push_back(outgoing.to.value());
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(queue.backlog_bytes(), 3u * (kNodeBytes + config.overhead_bytes));
  const AgentId near = told[0] == kFour[2] ? kFour[1] : kFour[2];
  const auto diverted = queue.take_for({near, told[0]});
  ASSERT_EQ(diverted.size(), 1u);
  EXPECT_EQ(diverted[0].to, near);
  for (int k = 1; !queue.empty(); ++k) {
    ASSERT_LT(k, 100);
    for (const Outgoing& outgoing : queue.take(kStart + k * std::chrono::milliseconds(100)))
      told.push_back(outgoing.to.value());
  }
  told.push_back(near);
  std::ranges::sort(told);
  EXPECT_EQ(told, kFour);
  EXPECT_EQ(queue.backlog_bytes(), 0u);
  EXPECT_EQ(queue.stats().sent[static_cast<std::size_t>(Priority::kNews)], 1u);

  queue.push_to({kFour[1], kFour[3]}, Priority::kState, Digest{kSelf, {}, {}});
  EXPECT_EQ(queue.backlog_bytes(),
            2u * testing::payload_size(Digest{kSelf, {}, {}}) + 2u * config.overhead_bytes);
  queue.push_to({kFour[1]}, Priority::kState, Digest{kSelf, {}, {}});
  EXPECT_EQ(queue.backlog_bytes(), testing::payload_size(Digest{kSelf, {}, {}}) + config.overhead_bytes);
  EXPECT_EQ(queue.take_for({kFour[1]}).size(), 1u);
  EXPECT_TRUE(queue.empty());
  queue.push_to({}, Priority::kState, Digest{kSelf, {}, {}});
  EXPECT_TRUE(queue.empty()) << "nobody is there";
}

TEST(SendQueue, an_order_goes_to_all_at_once_since_operators_hear_it_too) {
  SendQueue queue({}, kFour, testing::payload_size);
  queue.push(Priority::kSafety, Hold{});
  const auto out = queue.take(kStart);
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].to, std::nullopt);
}

/// The least share of clouds in any ten seconds while all of these kinds wait, and what went altogether.
struct Shares {
  double min_clouds = 1.0;
  double news = 0.0, backfill = 0.0, clouds = 0.0;  ///< B
};
Shares shares_of(bool news, bool backfill, double rate = 4000.0) {
  LongRangeConfig config;
  config.fleet_bytes_per_second = 5.0 * rate;
  SendQueue queue(config, kFour, testing::payload_size);
  Shares shares;
  std::deque<std::pair<Stamp, std::pair<bool, double>>> window;
  std::uint32_t seq = 0;
  for (int k = 0; k < 6000; ++k) {
    const Stamp now = kStart + std::chrono::milliseconds(20 * k);
    while (news && queue.size(Priority::kNews) < 50) queue.push(Priority::kNews, node(++seq));
    while (backfill && queue.size(Priority::kBackfill) < 50)
      queue.push(Priority::kBackfill, testing::make_node(agent("r3"), ++seq, Bytes{}), kPeer);
    if (queue.size(Priority::kCloud) < 2) {
      for (auto& f : split_cloud(kSelf, kPeer, {kSelf, ++seq}, Bytes(25'000, 1)))
        queue.push(Priority::kCloud, f);
    }
    for (const auto& outgoing : queue.take(now)) {
      const auto bytes = static_cast<double>(queue.wire_bytes(outgoing.message, outgoing.to));
      const auto* sent = std::get_if<graph::Node>(&outgoing.message);
      (sent == nullptr ? shares.clouds : sent->id.agent == kSelf ? shares.news : shares.backfill) += bytes;
      window.push_back({now, {sent == nullptr, bytes}});
    }
    while (!window.empty() && now - window.front().first >= std::chrono::seconds(10)) window.pop_front();
    if (now - kStart < std::chrono::seconds(10)) continue;
    double all = 0.0, clouds = 0.0;
    for (const auto& [at, sent] : window) (sent.first ? clouds : all) += sent.second;
    shares.min_clouds = std::min(shares.min_clouds, clouds / (all + clouds));
  }
  return shares;
}

TEST(SendQueue, clouds_get_half_of_the_bytes_of_any_ten_seconds_whatever_else_waits) {
  for (const auto& [news, backfill] : {std::pair{true, false}, {false, true}, {true, true}}) {
    const Shares shares = shares_of(news, backfill);
    EXPECT_GE(shares.min_clouds, 0.5) << news << backfill;
    const double all = shares.news + shares.backfill + shares.clouds;
    EXPECT_GT(shares.news + shares.backfill, 0.4 * all) << news << backfill;
    EXPECT_GT(all, 0.9 * 4000.0 * 120.0) << news << backfill;
  }
}

/// 60 kbit/s for five robots: a fragment takes most of a second's share.
TEST(SendQueue, news_have_their_part_where_a_fragment_takes_most_of_a_second) {
  const Shares shares = shares_of(true, false, 1500.0);
  EXPECT_GT(shares.news, 0.4 * (shares.news + shares.clouds));
  EXPECT_GE(shares.min_clouds, 0.5);
  EXPECT_GT(shares.news + shares.clouds, 0.7 * 1500.0 * 120.0);
}

TEST(SendQueue, shares_what_clouds_leave_evenly_between_news_and_backfill) {
  const Shares shares = shares_of(true, true);
  EXPECT_NEAR(shares.news, shares.backfill, 0.1 * shares.news);
}

}  // namespace
}  // namespace fleetmap::exchange
