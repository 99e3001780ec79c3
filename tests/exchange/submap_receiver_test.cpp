#include "submap_receiver.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "store/items.hpp"
#include "submap_sender.hpp"
#include "support/full_disk.hpp"

namespace fleetmap::exchange {
namespace {

using testing::agent;

TEST(SubmapReceiver, turns_from_a_peer_that_sends_wrong_content) {
  const testing::ScratchFolder folder;
  const AgentId self = agent("r1"), liar = agent("r2"), honest = agent("r3");
  auto store = store::Store::open(folder / "store.db", self).value();
  const Bytes submap = testing::random_bytes(20'000, 1);
  const NodeId id{agent("r4"), 0};
  ASSERT_TRUE(store.put_node(testing::make_node(id.agent, 0, submap)));
  SubmapReceiver receiver(self, {});
  Stamp now = stamp_from_ns(1'000'000'000);
  const auto serve = [&](const SubmapRequest& request) {
    for (std::uint32_t offset = request.offset; offset < request.offset + request.length;
         offset += SubmapChunk::kMaxPayload) {
      SubmapChunk chunk{request.to, self, id, offset, 20'000, {}};
      const ByteView part = ByteView(submap).subspan(offset, std::min<std::size_t>(8192, 20'000 - offset));
      chunk.payload.assign(part.begin(), part.end());
      if (request.to == liar) chunk.payload[5] ^= 1;
      ASSERT_TRUE(receiver.on_chunk(chunk, store, now));
    }
  };
  receiver.on_digest({liar, {{id.agent, 0, 1}}, {self}}, now);
  for (const auto& request : receiver.tick(store, now)) serve(request);
  EXPECT_EQ(receiver.stats().bad_hash, 1u);
  EXPECT_TRUE(receiver.tick(store, now).empty());  // not from this one again soon
  receiver.on_digest({honest, {{id.agent, 0, 1}}, {self}}, now);
  for (const auto& request : receiver.tick(store, now)) serve(request);
  EXPECT_EQ(store.submap(id).value(), submap);
  EXPECT_TRUE(receiver.idle(store, now));
}

TEST(SubmapReceiver, one_damaged_chunk_does_not_bar_its_source_for_ever) {
  const testing::ScratchFolder folder;
  const AgentId self = agent("r1"), maker = agent("r2"), forger = agent("r3");
  auto store = store::Store::open(folder / "store.db", self).value();
  const Bytes submap = testing::random_bytes(20'000, 1);
  const NodeId id{maker, 0};
  ASSERT_TRUE(store.put_node(testing::make_node(maker, 0, submap)));
  SubmapReceiver receiver(self, {});
  Stamp now = stamp_from_ns(1'000'000'000);
  const auto chunk_of = [&](const AgentId& from, std::uint32_t offset) {
    SubmapChunk chunk{from, self, id, offset, 20'000, {}};
    const ByteView part = ByteView(submap).subspan(offset, std::min<std::size_t>(8192, 20'000 - offset));
    chunk.payload.assign(part.begin(), part.end());
    return chunk;
  };
  SubmapChunk damaged = chunk_of(maker, 0);
  damaged.payload[7] ^= 1;
  ASSERT_TRUE(receiver.on_chunk(damaged, store, now)) << "before anything was asked for";
  EXPECT_EQ(receiver.stats().unasked, 1u);
  EXPECT_EQ(store.missing_chunks(id).size(), 3u);

  receiver.on_digest({maker, {{maker, 0, 1}}, {self}}, now);
  ASSERT_FALSE(receiver.tick(store, now).empty());
  ASSERT_TRUE(receiver.on_chunk(chunk_of(forger, 0), store, now)) << "of one who was not asked";
  EXPECT_EQ(receiver.stats().unasked, 2u);
  ASSERT_TRUE(receiver.on_chunk(damaged, store, now)) << "in the maker's name";
  for (const std::uint32_t offset : {8192u, 16384u}) {
    ASSERT_TRUE(receiver.on_chunk(chunk_of(maker, offset), store, now));
  }
  EXPECT_EQ(receiver.stats().bad_hash, 1u);
  EXPECT_TRUE(receiver.tick(store, now).empty());
  now += std::chrono::seconds(11);
  receiver.on_digest({maker, {{maker, 0, 1}}, {self}}, now);
  ASSERT_FALSE(receiver.tick(store, now).empty()) << "it is asked again";
  for (const std::uint32_t offset : {0u, 8192u, 16384u}) {
    ASSERT_TRUE(receiver.on_chunk(chunk_of(maker, offset), store, now));
  }
  EXPECT_EQ(store.submap(id).value(), submap);
}

TEST(SubmapReceiver, a_stuck_download_leaves_its_peer_for_another) {
  const testing::ScratchFolder folder;
  const AgentId self = agent("r1"), stuck = agent("r2"), other = agent("r3");
  auto store = store::Store::open(folder / "store.db", self).value();
  const Bytes submap = testing::random_bytes(20'000, 1);
  const NodeId id{agent("r4"), 0};
  ASSERT_TRUE(store.put_node(testing::make_node(id.agent, 0, submap)));
  SubmapReceiver receiver(self, {});
  const Stamp begun = stamp_from_ns(1'000'000'000);
  std::map<AgentId, Stamp> first_asked;
  int asked_of_stuck_later = 0;
  for (Stamp now = begun; !store.has_submap(id) && now - begun < std::chrono::seconds(60);
       now += std::chrono::milliseconds(100)) {
    // Both are there all the time; the first sends digests and no chunk.
    receiver.on_digest({stuck, {{id.agent, 0, 1}}, {self}}, now);
    if (now - begun >= std::chrono::seconds(1)) receiver.on_digest({other, {{id.agent, 0, 1}}, {self}}, now);
    for (const SubmapRequest& request : receiver.tick(store, now)) {
      first_asked.try_emplace(request.to, now);
      if (request.to == stuck) {
        asked_of_stuck_later += first_asked.contains(other) ? 1 : 0;
        continue;
      }
      for (std::uint32_t offset = request.offset; offset < request.offset + request.length; offset += 8192) {
        SubmapChunk chunk{other, self, id, offset, 20'000, {}};
        const ByteView part = ByteView(submap).subspan(offset, std::min<std::size_t>(8192, 20'000 - offset));
        chunk.payload.assign(part.begin(), part.end());
        ASSERT_TRUE(receiver.on_chunk(chunk, store, now));
      }
    }
  }
  ASSERT_TRUE(first_asked.contains(stuck));
  ASSERT_TRUE(first_asked.contains(other)) << "it stays with the one that sends nothing";
  EXPECT_LE(first_asked[other] - first_asked[stuck], std::chrono::seconds(10));
  EXPECT_EQ(asked_of_stuck_later, 0);
  EXPECT_EQ(store.submap(id).value(), submap);
}

TEST(SubmapReceiver, completes_what_it_holds_when_the_full_disk_has_room_again) {
  const testing::ScratchFolder folder;
  const AgentId self = agent("r1"), peer = agent("r2");
  auto store = store::Store::open(folder / "store.db", self).value();
  const Bytes submap = testing::random_bytes(100'000, 1);
  const NodeId id{peer, 0};
  ASSERT_TRUE(store.put_node(testing::make_node(peer, 0, submap)));
  SubmapTransferConfig config;
  config.window.first_bytes = config.window.max_bytes;
  SubmapReceiver receiver(self, config);
  Stamp now = stamp_from_ns(1'000'000'000);
  receiver.on_digest({peer, {{peer, 0, 1}}, {self}}, now);
  ASSERT_FALSE(receiver.tick(store, now).empty());
  const auto hear = [&](std::uint32_t offset) {
    SubmapChunk chunk{peer, self, id, offset, 100'000, {}};
    const ByteView part = ByteView(submap).subspan(offset, std::min<std::size_t>(8192, 100'000 - offset));
    chunk.payload.assign(part.begin(), part.end());
    return receiver.on_chunk(chunk, store, now);
  };
  for (std::uint32_t offset = 0; offset + 8192 < 100'000; offset += 8192) ASSERT_TRUE(hear(offset));
  {
    // The last chunk still fits, the whole does not.
    const testing::FullDisk full(std::filesystem::file_size(folder / "store.db-wal") + 50'000);
    EXPECT_FALSE(hear(12 * 8192));
    EXPECT_TRUE(store.missing_chunks(id).empty());
    EXPECT_FALSE(store.has_submap(id));
    now += std::chrono::seconds(6);
    EXPECT_TRUE(receiver.finish_downloads(store, now).failure) << "still full";
    EXPECT_FALSE(receiver.finish_downloads(store, now).failure) << "not before a pause";
    EXPECT_TRUE(receiver.tick(store, now).empty());
  }
  now += std::chrono::seconds(6);
  const auto finished = receiver.finish_downloads(store, now);
  ASSERT_FALSE(finished.failure) << finished.failure->message;
  EXPECT_EQ(finished.submaps, std::vector<NodeId>{id});
  EXPECT_EQ(store.submap(id).value(), submap);
}

TEST(SubmapReceiver, refuses_and_counts_hostile_chunks) {
  const testing::ScratchFolder folder;
  const AgentId self = agent("r1"), peer = agent("r2");
  auto store = store::Store::open(folder / "store.db", self).value();
  const Bytes submap = testing::random_bytes(20'000, 1);
  ASSERT_TRUE(store.put_node(testing::make_node(peer, 0, submap)));
  ASSERT_TRUE(store.put_node_with_submap(testing::make_node(self, 0, submap), submap));
  SubmapReceiver receiver(self, {});
  const Stamp now = stamp_from_ns(1'000'000'000);
  const NodeId id{peer, 0};
  const Bytes piece(8192, 1);
  const auto offer = [&](const NodeId& node, std::uint32_t offset, std::uint32_t total,
                         const Bytes& payload) {
    SubmapChunk chunk;
    chunk.from = peer;
    chunk.to = self;
    chunk.node = node;
    chunk.offset = offset;
    chunk.total_bytes = total;
    chunk.payload = payload;
    EXPECT_EQ(receiver.on_chunk(chunk, store, now).value(), std::nullopt);
  };
  offer(id, 1, 20'000, piece);
  offer(id, 8192, 20'001, piece);
  offer(id, 16'384, 20'000, piece);
  offer(id, 4'294'959'104u, 20'000, piece);
  offer(id, 0, 20'000, {});
  offer({peer, 9}, 0, 20'000, piece);
  offer({self, 1}, 0, 20'000, piece);
  EXPECT_EQ(receiver.stats().hostile, 7u);
  EXPECT_EQ(store.missing_chunks(id).size(), 3u);
}

TEST(SubmapSender, refuses_and_counts_hostile_requests) {
  const testing::ScratchFolder folder;
  const AgentId self = agent("r1"), peer = agent("r2");
  auto store = store::Store::open(folder / "store.db", self).value();
  const Bytes submap = testing::random_bytes(20'000, 1);
  ASSERT_TRUE(store.put_node(testing::make_node(peer, 0, submap)));
  ASSERT_TRUE(store.put_node_with_submap(testing::make_node(self, 0, submap), submap));
  const Stamp now = stamp_from_ns(1'000'000'000);
  SubmapSender sender(self, {});
  const NodeId own{self, 0};
  const auto ask = [&](const NodeId& node, std::uint32_t offset, std::uint32_t length) {
    SubmapRequest request;
    request.from = peer;
    request.to = self;
    request.node = node;
    request.offset = offset;
    request.length = length;
    sender.on_request(request, store);
  };
  ask({peer, 0}, 0, 8192);
  ask(own, 20'000, 8192);
  ask(own, 3, 8192);
  ask(own, 4'294'959'104u, 8192);
  ask(own, 0, 0);
  EXPECT_EQ(sender.stats().refused, 5u);
  EXPECT_TRUE(sender.idle());
  ask(own, 8192, UINT32_MAX);
  const auto chunks = sender.tick(store, now);
  ASSERT_EQ(chunks.size(), 2u);
  EXPECT_EQ(chunks[1].payload.size(), 20'000u - 16'384u);
}

}  // namespace
}  // namespace fleetmap::exchange
