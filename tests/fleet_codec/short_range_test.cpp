#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fleetmap/fleet_codec/messages.hpp"
#include "random_messages.hpp"
#include "wire_bytes.hpp"

namespace fleetmap::fleet_codec {
namespace {

using fleet_codec::testing::id;
using fleet_codec::testing::node_id;
using fleet_codec::testing::refusal;
using fleet_codec::testing::submap_chunk;
using fleet_codec::testing::WireBytes;
using ::testing::HasSubstr;

TEST(ShortRange, ADigestLiesOnTheWireAsTheIdlHasIt) {
  const messages::SubmapDigest digest{
      id("r1"), {{id("r2"), 3, 9}, {id("robot-08"), 65536, 65540}}, {id("x_9")}};
  WireBytes wire;
  wire.octet(kSchemaVersion)
      .name("r1")
      .u32(2)
      .name("r2")
      .u32(3)
      .u32(9)
      .name("robot-08")
      .u32(65536)
      .u32(65540);
  wire.u32(1).name("x_9");
  EXPECT_EQ(encode(digest), wire.bytes());
  const auto read = decode<messages::SubmapDigest>(wire.bytes());
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->from, digest.from);
  EXPECT_EQ(read->submaps, digest.submaps);
  EXPECT_EQ(read->hears, digest.hears);
}

TEST(ShortRange, ARequestLiesOnTheWireAsTheIdlHasIt) {
  const messages::SubmapRequest request{id("r1"), id("r2"), node_id("r3", 7), 8192, 65536};
  WireBytes wire;
  wire.octet(kSchemaVersion).name("r1").name("r2").name("r3").u32(7).u32(8192).u32(65536);
  EXPECT_EQ(encode(request), wire.bytes());
  const auto read = decode<messages::SubmapRequest>(wire.bytes());
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->from, request.from);
  EXPECT_EQ(read->to, request.to);
  EXPECT_EQ(read->node, request.node);
  EXPECT_EQ(read->offset, 8192u);
  EXPECT_EQ(read->length, 65536u);
}

TEST(ShortRange, AChunkLiesOnTheWireAsTheIdlHasIt) {
  messages::SubmapChunk chunk{id("r1"), id("r2"), node_id("r3", 7), 8192, 8195, Bytes(3, 5)};
  WireBytes wire;
  wire.octet(kSchemaVersion).name("r1").name("r2").name("r3").u32(7).u32(8192).u32(8195).u32(3).octets(3, 5);
  EXPECT_EQ(encode(chunk), wire.bytes());
  const auto read = decode<messages::SubmapChunk>(wire.bytes());
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->from, chunk.from);
  EXPECT_EQ(read->to, chunk.to);
  EXPECT_EQ(read->node, chunk.node);
  EXPECT_EQ(read->offset, 8192u);
  EXPECT_EQ(read->total_bytes, 8195u);
  EXPECT_EQ(read->payload, chunk.payload);
}

TEST(ShortRange, ALongDigestIsCutToWhatEveryReceiverTakes) {
  messages::SubmapDigest digest{id("r1"), {}, {}};
  for (std::uint32_t k = 0; k < kMaxSubmapRanges + 10; ++k)
    digest.submaps.push_back({id("r2"), 2 * k, 2 * k + 1});
  for (std::size_t k = 0; k < kMaxHeard + 10; ++k)
    digest.hears.push_back(id(("a" + std::to_string(k)).c_str()));
  const auto read = decode<messages::SubmapDigest>(encode(digest));
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->submaps.size(), kMaxSubmapRanges);
  EXPECT_EQ(read->submaps.back(), digest.submaps[kMaxSubmapRanges - 1]);
  ASSERT_EQ(read->hears.size(), kMaxHeard);
  EXPECT_EQ(read->hears.back(), digest.hears[kMaxHeard - 1]);
}

TEST(ShortRange, PiecesReachTheEndOfASubmapAndNoFarther) {
  EXPECT_EQ(refusal(submap_chunk(8192, 8192 + 100, 100)), "none");
  EXPECT_THAT(refusal(submap_chunk(8192, 8192 + 99, 100)), HasSubstr("the chunk reaches beyond total_bytes"));
  EXPECT_EQ(refusal(submap_chunk(kMaxSubmapBytes - 1, kMaxSubmapBytes, 1)), "none");
  EXPECT_THAT(refusal(submap_chunk(0, kMaxSubmapBytes + 1, 1)), HasSubstr("total_bytes is beyond 64 MiB"));
  messages::SubmapRequest request{id("r1"), id("r2"), node_id("r3", 7), kMaxSubmapBytes - 10, 10};
  EXPECT_EQ(refusal(request), "none");
  request.length = 11;
  EXPECT_THAT(refusal(request), HasSubstr("SubmapRequest: offset + length is beyond 64 MiB"));
}

TEST(ShortRange, NamesAndRangesAreChecked) {
  EXPECT_THAT(refusal(messages::SubmapDigest{{}, {}, {}}), HasSubstr("SubmapDigest: sender: agent id"));
  EXPECT_THAT(refusal(messages::SubmapDigest{id("r1"), {}, {AgentId()}}), HasSubstr("hears: agent id"));
  EXPECT_THAT(refusal(messages::SubmapDigest{id("r1"), {{id("r2"), 9, 8}}, {}}),
              HasSubstr("submaps: range [9, 8) is out of order or too large"));
  EXPECT_THAT(refusal(messages::SubmapRequest{id("r1"), {}, node_id("r3", 7), 0, 1}),
              HasSubstr("recipient: agent id"));
  EXPECT_THAT(refusal(messages::SubmapRequest{id("r1"), id("r2"), {id("r3"), kEndOfSeqs}, 0, 1}),
              HasSubstr("node: sequence number 4294901760 is too large"));
}

}  // namespace
}  // namespace fleetmap::fleet_codec
