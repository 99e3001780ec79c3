#include "submap_receiver.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "exchange/robots.hpp"
#include "exchange/submap_chunks.hpp"
#include "store/items.hpp"
#include "support/full_disk.hpp"

namespace fleetmap::exchange {
namespace {

/// A robot that has a node of kPeer and lacks its submap of `bytes` bytes.
class SubmapReceiverTest : public ::testing::Test {
 protected:
  explicit SubmapReceiverTest(std::uint32_t bytes = 20'000) : submap_(testing::random_bytes(bytes, 1)) {
    EXPECT_TRUE(store_.put_node(testing::make_node(kPeer, 0, submap_)));
  }
  /// `from` holds the submap and hears this robot.
  void offer(SubmapReceiver& receiver, const AgentId& from) {
    receiver.on_digest({from, {{kPeer, 0, 1}}, {kSelf}}, now_);
  }
  SubmapChunk chunk_of(const AgentId& from, std::uint32_t offset) const {
    SubmapChunk chunk{from, kSelf, id_, offset, static_cast<std::uint32_t>(submap_.size()), {}};
    const ByteView part = ByteView(submap_).subspan(offset);
    chunk.payload.assign(part.begin(), part.begin() + std::min<std::ptrdiff_t>(kChunk, std::ssize(part)));
    return chunk;
  }
  std::vector<SubmapChunk> chunks_of(const SubmapRequest& request) const {
    std::vector<SubmapChunk> chunks;
    for (std::uint32_t offset = request.offset; offset < request.offset + request.length; offset += kChunk)
      chunks.push_back(chunk_of(request.to, offset));
    return chunks;
  }

  const testing::TemporaryFolder folder_;
  store::Store store_ = store::Store::open(folder_ / "store.db", kSelf).value();
  const Bytes submap_;
  const NodeId id_{kPeer, 0};
  Stamp now_ = stamp_from_ns(1'000'000'000);
};

TEST_F(SubmapReceiverTest, turns_from_a_peer_that_sends_wrong_content) {
  SubmapReceiver receiver(kSelf, {});
  const auto serve = [&](const SubmapRequest& request) {
    for (SubmapChunk& chunk : chunks_of(request)) {
      if (request.to == kPeer) chunk.payload[5] ^= 1;
      ASSERT_TRUE(receiver.on_chunk(chunk, store_, now_));
    }
  };
  offer(receiver, kPeer);
  for (const auto& request : receiver.tick(store_, now_)) serve(request);
  EXPECT_EQ(receiver.stats().bad_hash, 1u);
  EXPECT_TRUE(receiver.tick(store_, now_).empty());  // not from this one again soon
  offer(receiver, kThird);
  for (const auto& request : receiver.tick(store_, now_)) serve(request);
  EXPECT_EQ(store_.submap(id_).value(), submap_);
  EXPECT_TRUE(receiver.idle(store_, now_));
}

TEST_F(SubmapReceiverTest, one_damaged_chunk_does_not_bar_its_source_for_ever) {
  SubmapReceiver receiver(kSelf, {});
  SubmapChunk damaged = chunk_of(kPeer, 0);
  damaged.payload[7] ^= 1;
  ASSERT_TRUE(receiver.on_chunk(damaged, store_, now_)) << "before anything was asked for";
  EXPECT_EQ(receiver.stats().unasked, 1u);
  EXPECT_EQ(store_.missing_chunks(id_).size(), 3u);

  offer(receiver, kPeer);
  ASSERT_FALSE(receiver.tick(store_, now_).empty());
  ASSERT_TRUE(receiver.on_chunk(chunk_of(kThird, 0), store_, now_)) << "of one who was not asked";
  EXPECT_EQ(receiver.stats().unasked, 2u);
  ASSERT_TRUE(receiver.on_chunk(damaged, store_, now_)) << "in the maker's name";
  for (const std::uint32_t offset : {kChunk, 2 * kChunk})
    ASSERT_TRUE(receiver.on_chunk(chunk_of(kPeer, offset), store_, now_));
  EXPECT_EQ(receiver.stats().bad_hash, 1u);
  EXPECT_TRUE(receiver.tick(store_, now_).empty());
  now_ += std::chrono::seconds(11);
  offer(receiver, kPeer);
  ASSERT_FALSE(receiver.tick(store_, now_).empty()) << "it is asked again";
  for (const std::uint32_t offset : {0u, kChunk, 2 * kChunk})
    ASSERT_TRUE(receiver.on_chunk(chunk_of(kPeer, offset), store_, now_));
  EXPECT_EQ(store_.submap(id_).value(), submap_);
}

TEST_F(SubmapReceiverTest, a_stuck_download_leaves_its_peer_for_another) {
  SubmapReceiver receiver(kSelf, {});
  const Stamp begun = now_;
  std::map<AgentId, Stamp> first_asked;
  int asked_of_stuck_later = 0;
  for (; !store_.has_submap(id_) && now_ - begun < std::chrono::seconds(60);
       now_ += std::chrono::milliseconds(100)) {
    // Both are there all the time; the first sends digests and no chunk.
    offer(receiver, kPeer);
    if (now_ - begun >= std::chrono::seconds(1)) offer(receiver, kThird);
    for (const SubmapRequest& request : receiver.tick(store_, now_)) {
      first_asked.try_emplace(request.to, now_);
      if (request.to == kPeer) {
        asked_of_stuck_later += first_asked.contains(kThird) ? 1 : 0;
        continue;
      }
      for (const SubmapChunk& chunk : chunks_of(request)) ASSERT_TRUE(receiver.on_chunk(chunk, store_, now_));
    }
  }
  ASSERT_TRUE(first_asked.contains(kPeer));
  ASSERT_TRUE(first_asked.contains(kThird)) << "it stays with the one that sends nothing";
  EXPECT_LE(first_asked[kThird] - first_asked[kPeer], std::chrono::seconds(10));
  EXPECT_EQ(asked_of_stuck_later, 0);
  EXPECT_EQ(store_.submap(id_).value(), submap_);
}

class LargeSubmap : public SubmapReceiverTest {
 protected:
  LargeSubmap() : SubmapReceiverTest(100'000) {}
};

TEST_F(LargeSubmap, is_completed_when_the_full_disk_has_room_again) {
  SubmapTransferConfig config;
  config.window.first_bytes = config.window.max_bytes;
  SubmapReceiver receiver(kSelf, config);
  offer(receiver, kPeer);
  ASSERT_FALSE(receiver.tick(store_, now_).empty());
  const auto receive = [&](std::uint32_t chunk) {
    return receiver.on_chunk(chunk_of(kPeer, chunk * kChunk), store_, now_);
  };
  for (std::uint32_t chunk = 0; chunk < 12; ++chunk) ASSERT_TRUE(receive(chunk));
  {
    // The last chunk still fits, the whole does not.
    const testing::FullDisk full(std::filesystem::file_size(folder_ / "store.db-wal") + 50'000);
    EXPECT_FALSE(receive(12));
    EXPECT_TRUE(store_.missing_chunks(id_).empty());
    EXPECT_FALSE(store_.has_submap(id_));
    now_ += std::chrono::seconds(6);
    EXPECT_TRUE(receiver.finish_downloads(store_, now_).failure) << "still full";
    EXPECT_FALSE(receiver.finish_downloads(store_, now_).failure) << "not before a pause";
    EXPECT_TRUE(receiver.tick(store_, now_).empty());
  }
  now_ += std::chrono::seconds(6);
  const auto finished = receiver.finish_downloads(store_, now_);
  ASSERT_FALSE(finished.failure) << finished.failure->message;
  EXPECT_EQ(finished.submaps, std::vector<NodeId>{id_});
  EXPECT_EQ(store_.submap(id_).value(), submap_);
}

TEST_F(SubmapReceiverTest, refuses_and_counts_hostile_chunks) {
  ASSERT_TRUE(store_.put_node_with_submap(testing::make_node(kSelf, 0, submap_), submap_));
  SubmapReceiver receiver(kSelf, {});
  const Bytes piece(kChunk, 1);
  const auto offer = [&](const NodeId& node, std::uint32_t offset, std::uint32_t total,
                         const Bytes& payload) {
    const SubmapChunk chunk{kPeer, kSelf, node, offset, total, payload};
    EXPECT_EQ(receiver.on_chunk(chunk, store_, now_).value(), std::nullopt);
  };
  offer(id_, 1, 20'000, piece);
  offer(id_, kChunk, 20'001, piece);
  offer(id_, 2 * kChunk, 20'000, piece);
  offer(id_, 4'294'959'104u, 20'000, piece);
  offer(id_, 0, 20'000, {});
  offer({kPeer, 9}, 0, 20'000, piece);
  offer({kSelf, 1}, 0, 20'000, piece);
  EXPECT_EQ(receiver.stats().hostile, 7u);
  EXPECT_EQ(store_.missing_chunks(id_).size(), 3u);
}

}  // namespace
}  // namespace fleetmap::exchange
