#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/fleet_codec/topics.hpp"
#include "fleetmap_long_range.h"
#include "fleetmap_short_range.h"
#include "random_messages.hpp"

// Anybody can send bytes over the network, so decoding must survive all of them.
namespace fleetmap::fleet_codec {
namespace {

using fleet_codec::testing::cloud_fragment;
using fleet_codec::testing::id;
using fleet_codec::testing::node_id;
using fleet_codec::testing::RandomMessages;
using fleet_codec::testing::submap_chunk;
using ::testing::HasSubstr;

constexpr std::size_t kHeader = 4;

template <class T>
std::string refusal(const Bytes& bytes) {
  const auto result = decode<T>(bytes);
  return result ? "accepted" : result.error().message;
}

/// Little-endian, at `offset` of the body.
void put32(Bytes& bytes, std::size_t offset, std::uint32_t value) {
  for (int k = 0; k < 4; ++k)
    bytes.at(kHeader + offset + static_cast<std::size_t>(k)) = static_cast<std::uint8_t>(value >> (8 * k));
}

TEST(HostileBytes, EveryTruncationIsRefused) {
  RandomMessages random(11);
  for (const messages::Message& message : random.one_of_each()) {
    const Bytes whole = encode(message);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const auto decoded = decode_message(topic_of(message), ByteView(whole).first(size));
      EXPECT_FALSE(decoded) << topic_of(message).type << " of " << size << " of " << whole.size() << " bytes";
    }
  }
}

/// A message that is accepted after damage is one that could have been sent: its encoding decodes to itself.
TEST(HostileBytes, DamagedMessagesAreRefusedOrSound) {
  RandomMessages random(12);
  std::size_t accepted = 0, refused = 0;
  for (int round = 0; round < 400; ++round) {
    for (const messages::Message& message : random.one_of_each()) {
      Bytes bytes = encode(message);
      for (std::uint32_t flips = random.integer(1, 8); flips > 0; --flips) {
        bytes[random.integer(0, static_cast<std::uint32_t>(std::min<std::size_t>(bytes.size(), 120) - 1))] ^=
            static_cast<std::uint8_t>(1u << random.integer(0, 7));
      }
      const auto decoded = decode_message(topic_of(message), bytes);
      if (!decoded) {
        EXPECT_THAT(decoded.error().message, HasSubstr("fleetmap::msg::"));
        ++refused;
        continue;
      }
      ++accepted;
      const Bytes again = encode(*decoded);
      const auto twice = decode_message(topic_of(message), again);
      ASSERT_TRUE(twice) << twice.error().message;
      EXPECT_EQ(encode(*twice), again);
    }
  }
  EXPECT_GT(accepted, 100u);
  EXPECT_GT(refused, 1000u);
}

TEST(HostileBytes, NoiseIsRefusedByEveryDecoder) {
  RandomMessages random(13);
  for (int round = 0; round < 2000; ++round) {
    Bytes bytes = random.bytes(random.integer(5, 400));
    bytes[0] = 0;
    bytes[1] = static_cast<std::uint8_t>(round & 1);
    if (round % 3 == 0) bytes[kHeader] = kSchemaVersion;
    for (const messages::Message& message : random.one_of_each())
      EXPECT_FALSE(decode_message(topic_of(message), bytes));
    EXPECT_FALSE(decode<GlobalPose>(bytes));
    EXPECT_FALSE(decode<messages::SpherizedCloud>(bytes));
  }
}

TEST(HostileBytes, AnotherSchemaVersionIsRefusedNamingBoth) {
  RandomMessages random(14);
  Bytes bytes = encode(random.node());
  bytes[kHeader] = 9;
  EXPECT_EQ(refusal<graph::Node>(bytes),
            "fleetmap::msg::Node: the sender speaks schema version 9, this program version " +
                std::to_string(kSchemaVersion) +
                "; "
                "run the same release on all robots");
}

TEST(HostileBytes, AnnouncedLengthsAreNotBelieved) {
  Bytes digest = encode(messages::Digest{id("r1"), {}, {}});
  put32(digest, 12, 0xffffffff);
  EXPECT_THAT(refusal<messages::Digest>(digest), HasSubstr("truncated or malformed"));
  Bytes chunk = encode(submap_chunk(0, 64, 64));
  put32(chunk, 40, 0x7fffffff);
  EXPECT_THAT(refusal<messages::SubmapChunk>(chunk), HasSubstr("truncated or malformed"));
  EXPECT_THAT(refusal<messages::Digest>(Bytes(40'000)), HasSubstr("schema version 0"));
  Bytes large(40'000);
  large[kHeader] = kSchemaVersion;
  EXPECT_THAT(refusal<messages::Digest>(large), HasSubstr("40000 bytes are more than this type can have"));
}

TEST(HostileBytes, AgentNamesAreChecked) {
  const messages::SubmapRequest request{id("r1"), id("r2"), node_id("r1", 0), 0, 1};
  Bytes bytes = encode(request);
  bytes[kHeader + 1] = '/';
  EXPECT_THAT(refusal<messages::SubmapRequest>(bytes),
              HasSubstr("sender: agent id must be 1 to 8 characters"));
  bytes = encode(request);
  bytes[kHeader + 5] = 'x';
  EXPECT_THAT(refusal<messages::SubmapRequest>(bytes),
              HasSubstr("sender: agent id is not padded with zeros"));
  EXPECT_THAT(refusal<messages::SubmapRequest>(encode(messages::SubmapRequest{})),
              HasSubstr("sender: agent id"));
}

TEST(HostileBytes, PiecesMustFitTheirWhole) {
  const auto good = cloud_fragment(2500, 2, 3, 300);
  ASSERT_TRUE(decode<messages::CloudFragment>(encode(good)));
  auto bad = good;
  bad.index = 3;
  EXPECT_THAT(refusal<messages::CloudFragment>(encode(bad)), HasSubstr("index is not below count"));
  bad = good;
  bad.count = 4;
  EXPECT_THAT(refusal<messages::CloudFragment>(encode(bad)), HasSubstr("count does not fit total_bytes"));
  bad = good;
  bad.payload.resize(299);
  EXPECT_THAT(refusal<messages::CloudFragment>(encode(bad)),
              HasSubstr("payload does not have the length of its piece"));
  bad = good;
  bad.total_bytes = 4'000'000'000;
  EXPECT_THAT(refusal<messages::CloudFragment>(encode(bad)),
              HasSubstr("total_bytes is 0 or more than a cloud can have"));
  const auto chunk = submap_chunk(0xfffffff0, 100, 64);
  EXPECT_THAT(refusal<messages::SubmapChunk>(encode(chunk)),
              HasSubstr("the chunk reaches beyond total_bytes"));
  messages::SubmapRequest request{id("r1"), id("r2"), node_id("r1", 0), 0xffffffff, 0xffffffff};
  EXPECT_THAT(refusal<messages::SubmapRequest>(encode(request)),
              HasSubstr("offset + length is beyond 64 MiB"));
  messages::Digest digest{id("r1"), {{id("r1"), 9, 3}}, {}};
  EXPECT_THAT(refusal<messages::Digest>(encode(digest)), HasSubstr("nodes: range [9, 3) is out of order"));
  digest.nodes = {{id("r1"), 0, 0xffffffff}};
  EXPECT_THAT(refusal<messages::Digest>(encode(digest)), HasSubstr("too large"));
  digest.nodes = {{id("r1"), 0, 4}};
  EXPECT_THAT(refusal<messages::Digest>(encode(digest)), HasSubstr("one print for each range"));
}

TEST(HostileBytes, NumbersMustMakeSense) {
  RandomMessages random(15);
  auto alignment = random.alignment();
  alignment.modes.front().rmse = -1.0;
  EXPECT_THAT(refusal<graph::Alignment>(encode(alignment)),
              HasSubstr("rmse is negative, not finite or too large"));
  alignment = random.alignment();
  alignment.modes.back().score = 1.1;
  EXPECT_THAT(refusal<graph::Alignment>(encode(alignment)),
              HasSubstr("score is negative, not finite or too large"));
  alignment.modes.clear();
  EXPECT_THAT(refusal<graph::Alignment>(encode(alignment)), HasSubstr("the number of modes is not 1 to 6"));
  alignment = random.alignment();
  alignment.j = alignment.i;
  EXPECT_THAT(refusal<graph::Alignment>(encode(alignment)), HasSubstr("nodes i and j are the same"));
  Bytes mode = encode(random.alignment());
  // The first element of the covariance's root, a half float, lies 36 bytes into the first mode, which begins
  // at 44.
  for (const auto& [high, low] : {std::pair(0x7c, 0x00), {0x7e, 0x00}, {0x80, 0x00}, {0xbc, 0x00}}) {
    mode[kHeader + 44 + 36] = static_cast<std::uint8_t>(low);
    mode[kHeader + 44 + 37] = static_cast<std::uint8_t>(high);
    EXPECT_THAT(refusal<graph::Alignment>(mode), HasSubstr("covariance is not finite or beyond its range"));
  }
  auto node = random.node();
  node.stamp = stamp_from_ns(-1);
  EXPECT_THAT(refusal<graph::Node>(encode(node)), HasSubstr("stamp is outside 1970 to 2116"));
  auto pose = random.global_pose();
  pose.q_enu_base.coeffs().setZero();
  EXPECT_THAT(refusal<GlobalPose>(encode(pose)), HasSubstr("norm of orientation"));
}

TEST(HostileBytes, AMessageOfAnotherTypeIsRefused) {
  RandomMessages random(16);
  const auto wrong = decode_message(topics::global_pose(), encode(random.node()));
  EXPECT_THAT(wrong.error().message,
              HasSubstr("'fleetmap::msg::GlobalPose' is not a message between agents"));
  EXPECT_THAT(refusal<graph::Alignment>(encode(random.node())), HasSubstr("fleetmap::msg::Alignment"));
}

}  // namespace
}  // namespace fleetmap::fleet_codec
