#include "fleetmap/exchange/send_queue.hpp"

#include <gtest/gtest.h>

#include <random>

#include "exchange/sim_fleet.hpp"

namespace fleetmap::exchange {
namespace {

using testing::agent;

const AgentId kSelf = agent("r1");
const AgentId kPeer = agent("r2");
const Stamp kStart = stamp_from_ns(1'000'000'000);

graph::Node node(std::uint32_t seq) { return testing::make_node(kSelf, seq, Bytes{}); }

TEST(TokenBucket, never_lets_out_more_than_rate_times_window_plus_burst) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    TokenBucket bucket(4000.0, 2000.0);
    std::vector<std::pair<Stamp, double>> taken;
    Stamp now = kStart;
    for (int k = 0; k < 3000; ++k) {
      now += std::chrono::milliseconds(random() % (seed % 2 ? 5 : 300));
      const double bytes = static_cast<double>(1 + random() % 2600);
      if (bucket.take(bytes, now, static_cast<double>(random() % 400))) taken.emplace_back(now, bytes);
    }
    ASSERT_GT(taken.size(), 100u);
    for (std::size_t first = 0; first < taken.size(); first += 7) {
      double sum = 0.0;
      for (std::size_t last = first; last < taken.size(); ++last) {
        sum += taken[last].second;
        const double window = to_seconds(taken[last].first - taken[first].first);
        ASSERT_LE(sum, 4000.0 * window + 2600.0 + 1e-3);
      }
    }
  }
}

TEST(TokenBucket, refills_nothing_when_the_clock_runs_backwards) {
  TokenBucket bucket(1000.0, 1000.0);
  EXPECT_TRUE(bucket.take(1000.0, kStart));
  EXPECT_FALSE(bucket.take(1.0, kStart - std::chrono::seconds(100)));
  EXPECT_FALSE(bucket.take(1000.0, kStart + std::chrono::milliseconds(999)));
  EXPECT_TRUE(bucket.take(1000.0, kStart + std::chrono::milliseconds(1000)));
}

TEST(SendQueue, sends_small_messages_before_clouds_that_wait_longer) {
  LongRangeConfig config;
  config.burst_seconds = 0.5;
  SendQueue queue(config, 2, testing::payload_size);
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
  EXPECT_EQ(out[1].to, std::nullopt);
  EXPECT_TRUE(std::holds_alternative<Digest>(out[2].message));
  EXPECT_TRUE(std::holds_alternative<CloudFragment>(out[3].message));
  // The bucket is empty but for the reserve, so a small message need not wait for the clouds.
  queue.push(Priority::kNews, node(2));
  EXPECT_EQ(queue.take(kStart).size(), 1u);
}

TEST(SendQueue, replaces_what_is_stale_and_counts_what_it_drops) {
  LongRangeConfig config;
  config.max_small = 3;
  SendQueue queue(config, 2, testing::payload_size);
  AgentStatus status;
  for (std::uint32_t k = 0; k < 5; ++k) {
    status.nodes = k;
    queue.push(Priority::kState, status);
  }
  EXPECT_EQ(queue.size(Priority::kState), 1u);
  EXPECT_EQ(queue.stats().superseded, 4u);
  EXPECT_EQ(queue.backlog_bytes(), 72u + config.overhead_bytes);
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
  SendQueue queue({}, 2, testing::payload_size);
  for (const std::uint32_t seq : {0u, 1u}) {
    for (auto& f : split_cloud(kSelf, kPeer, {kSelf, seq}, Bytes(25'000, 1))) queue.push(Priority::kCloud, f);
  }
  EXPECT_EQ(queue.size(Priority::kCloud), 46u);
  EXPECT_EQ(queue.cancel_cloud(kPeer, {kSelf, 1}), 23u);
  EXPECT_EQ(queue.cancel_cloud(agent("r3"), {kSelf, 0}), 0u);
  EXPECT_EQ(queue.size(Priority::kCloud), 23u);
}

TEST(SendQueue, counts_every_copy_and_header) {
  LongRangeConfig config;
  config.fleet_bytes_per_second = 20'000;
  config.overhead_bytes = 160;
  SendQueue queue(config, 5, testing::payload_size);
  EXPECT_EQ(queue.wire_bytes(node(0), std::nullopt), 4u * 260u);
  EXPECT_EQ(queue.wire_bytes(node(0), kPeer), 260u);
  EXPECT_DOUBLE_EQ(queue.share_bytes_per_second(), 4000.0);
  config.deliver_to_one = false;
  EXPECT_EQ(SendQueue(config, 5, testing::payload_size).wire_bytes(node(0), kPeer), 4u * 260u);
  config.multicast = true;
  EXPECT_EQ(SendQueue(config, 5, testing::payload_size).wire_bytes(node(0), std::nullopt), 260u);
}

TEST(SendQueue, shares_the_rest_evenly_between_backfill_and_clouds) {
  LongRangeConfig config;
  config.fleet_bytes_per_second = 20'000;
  config.burst_seconds = 0.5;
  config.max_backfill = 2000;
  SendQueue queue(config, 2, testing::payload_size);
  for (std::uint32_t seq = 0; seq < 2000; ++seq) queue.push(Priority::kBackfill, node(seq), kPeer);
  for (std::uint32_t seq = 0; seq < 20; ++seq) {
    for (auto& f : split_cloud(kSelf, kPeer, {kSelf, seq}, Bytes(25'000, 1))) queue.push(Priority::kCloud, f);
  }
  double bytes[2] = {0.0, 0.0};
  for (int k = 0; k < 500; ++k) {
    for (const auto& outgoing : queue.take(kStart + std::chrono::milliseconds(20 * k))) {
      bytes[std::holds_alternative<CloudFragment>(outgoing.message)] +=
          static_cast<double>(queue.wire_bytes(outgoing.message, outgoing.to));
    }
  }
  EXPECT_NEAR(bytes[0], bytes[1], 2000.0);
  EXPECT_GT(bytes[0] + bytes[1], 0.97 * 10'000.0 * 10.0);
}

}  // namespace
}  // namespace fleetmap::exchange
