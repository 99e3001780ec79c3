#include "cloud_transfer.hpp"

#include <gtest/gtest.h>

#include <random>

#include "exchange/robots.hpp"
#include "store/items.hpp"

namespace fleetmap::exchange {
namespace {

using testing::agent;
using testing::random_bytes;

const NodeId kCloudNode{kPeer, 4};
constexpr Duration kTick = std::chrono::milliseconds(100);

CloudRequest request_for(std::uint32_t seq, std::vector<std::uint16_t> missing = {}) {
  CloudRequest request;
  request.from = kSelf;
  request.to = kPeer;
  request.node = {kPeer, seq};
  request.missing = std::move(missing);
  return request;
}

TEST(CloudTransfer, carries_any_cloud_through_loss_disorder_and_doubles) {
  for (std::uint32_t seed = 0; seed < 120; ++seed) {
    std::mt19937 random(seed);
    const double loss = std::array{0.0, 0.1, 0.3}[seed % 3];
    const Bytes cloud = random_bytes(1 + random() % 25'600, seed);
    CloudSender sender(kPeer, {});
    CloudReceiver receiver(kSelf, {});
    ASSERT_TRUE(sender.offer(kCloudNode, cloud, kStart));
    ASSERT_TRUE(receiver.want(kCloudNode, kStart));
    std::optional<Bytes> whole;
    std::uint64_t fragments_sent = 0;
    std::uint64_t lost = 0;
    for (Stamp now = kStart; !whole && !receiver.idle() && now < kStart + std::chrono::minutes(5);
         now += kTick) {
      for (const auto& request : receiver.tick(now).requests) {
        if (std::uniform_real_distribution<>(0, 1)(random) < loss) continue;
        auto fragments = sender.answer(request, now);
        ASSERT_TRUE(fragments);
        std::ranges::shuffle(*fragments, random);
        for (const auto& fragment : *fragments) {
          ++fragments_sent;
          if (std::uniform_real_distribution<>(0, 1)(random) < loss) {
            ++lost;
            continue;
          }
          const int copies = random() % 5 == 0 ? 2 : 1;
          for (int copy = 0; copy < copies; ++copy) {
            if (auto done = receiver.add(fragment, now)) whole = std::move(done);
          }
        }
      }
    }
    ASSERT_TRUE(whole) << "seed " << seed;
    EXPECT_EQ(*whole, cloud);
    EXPECT_TRUE(receiver.idle());
    // Selective: only what was lost is sent again.
    EXPECT_EQ(fragments_sent, (cloud.size() + 1099) / 1100 + lost);
  }
}

TEST(CloudTransfer, refuses_and_counts_hostile_fragments) {
  const Bytes cloud = random_bytes(5000, 1);
  const auto good = split_cloud(kPeer, kSelf, kCloudNode, cloud);
  std::vector<CloudFragment> hostile;
  const auto spoil = [&](auto change) {
    CloudFragment fragment = good[1];
    change(fragment);
    hostile.push_back(fragment);
  };
  spoil([](auto& f) { f.index = f.count; });
  spoil([](auto& f) { f.index = 65535; });
  spoil([](auto& f) { f.count = 0; });
  spoil([](auto& f) { f.count = 65535; });
  spoil([](auto& f) { f.total_bytes = 0; });
  spoil([](auto& f) { f.total_bytes = UINT32_MAX; });
  spoil([](auto& f) { f.total_bytes = 4000; });
  spoil([](auto& f) { f.payload.pop_back(); });
  spoil([](auto& f) { f.payload.clear(); });
  spoil([](auto& f) { f.payload.push_back(0); });
  spoil([](auto& f) { f.cloud_hash[0] ^= 1; });
  spoil([](auto& f) { f.from = agent("r3"); });
  spoil([](auto& f) { f.to = agent("r3"); });
  CloudReceiver receiver(kSelf, {});
  ASSERT_TRUE(receiver.want(kCloudNode, kStart));
  EXPECT_FALSE(receiver.add(good[0], kStart));
  for (const auto& fragment : hostile) EXPECT_FALSE(receiver.add(fragment, kStart));
  EXPECT_EQ(receiver.stats().hostile, hostile.size());
  std::optional<Bytes> whole;
  for (std::size_t k = 1; k < good.size(); ++k) whole = receiver.add(good[k], kStart);
  EXPECT_EQ(whole, cloud);
  EXPECT_FALSE(receiver.add(good[0], kStart));  // nobody waits any more
  EXPECT_EQ(receiver.stats().unasked, 1u);
}

TEST(CloudTransfer, begins_again_when_the_sender_made_the_cloud_anew) {
  CloudSender sender(kPeer, {});
  CloudReceiver receiver(kSelf, {});
  const Bytes fresh = random_bytes(9000, 2);
  ASSERT_TRUE(receiver.want(kCloudNode, kStart));
  receiver.add(split_cloud(kPeer, kSelf, kCloudNode, random_bytes(8000, 1))[0], kStart);
  ASSERT_TRUE(sender.offer(kCloudNode, fresh, kStart));
  std::optional<Bytes> whole;
  for (Stamp now = kStart; !whole && now < kStart + std::chrono::minutes(2); now += kTick) {
    for (const auto& request : receiver.tick(now).requests) {
      const auto answer = sender.answer(request, now);
      for (const auto& fragment : *answer) {
        if (auto done = receiver.add(fragment, now)) whole = done;
      }
    }
  }
  EXPECT_EQ(whole, fresh);
}

TEST(CloudTransfer, gives_up_on_a_silent_or_lying_sender_and_counts_it) {
  CloudReceiver receiver(kSelf, {});
  ASSERT_TRUE(receiver.want(kCloudNode, kStart));
  std::size_t requests = 0;
  std::vector<NodeId> abandoned;
  Stamp now = kStart;
  for (; abandoned.empty() && now < kStart + std::chrono::minutes(10); now += kTick) {
    auto due = receiver.tick(now);
    requests += due.requests.size();
    abandoned = due.abandoned;
  }
  EXPECT_EQ(abandoned, std::vector<NodeId>{kCloudNode});
  EXPECT_EQ(requests, 8u);
  EXPECT_TRUE(receiver.idle());
  // A sender whose clouds never match their hash.
  ASSERT_TRUE(receiver.want(kCloudNode, now));
  abandoned.clear();
  for (const Stamp end = now + std::chrono::minutes(10); abandoned.empty() && now < end; now += kTick) {
    auto due = receiver.tick(now);
    abandoned = due.abandoned;
    for (std::size_t k = 0; k < due.requests.size(); ++k) {
      auto fragment = split_cloud(kPeer, kSelf, kCloudNode, Bytes(100, 7))[0];
      fragment.payload[0] ^= 1;
      EXPECT_FALSE(receiver.add(fragment, now));
    }
  }
  EXPECT_EQ(abandoned, std::vector<NodeId>{kCloudNode});
  EXPECT_EQ(receiver.stats().bad_hash, 3u);
  EXPECT_EQ(receiver.stats().abandoned, 2u);
}

TEST(CloudTransfer, bounds_what_it_keeps_and_what_it_takes_on) {
  CloudTransferConfig config;
  CloudReceiver receiver(kSelf, config);
  for (std::uint32_t seq = 0; seq < 20; ++seq) {
    EXPECT_EQ(receiver.want({kPeer, seq}, kStart), seq < config.max_receiving);
  }
  CloudSender sender(kPeer, config);
  EXPECT_FALSE(sender.offer(kCloudNode, Bytes(config.max_cloud_bytes + 1, 0), kStart));
  EXPECT_FALSE(sender.offer(kCloudNode, Bytes{}, kStart));
  for (std::uint32_t seq = 0; seq < 20; ++seq) {
    ASSERT_TRUE(sender.offer({kPeer, seq}, Bytes(100, 0), kStart + std::chrono::seconds(seq)));
  }
  EXPECT_FALSE(sender.answer(request_for(3), kStart));
  EXPECT_TRUE(sender.answer(request_for(4), kStart));
  EXPECT_TRUE(sender.answer(request_for(4, {5, 6, 65535}), kStart)->empty());
  EXPECT_EQ(sender.stats().bad_requests, 3u);
  EXPECT_FALSE(sender.answer(request_for(19), kStart + std::chrono::minutes(5)));  // stale
}

}  // namespace
}  // namespace fleetmap::exchange
