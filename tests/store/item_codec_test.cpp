#include "item_codec.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "store/agents.hpp"
#include "store/items.hpp"

namespace fleetmap::store {
namespace {

using testing::agent;
using testing::kSelf;
using testing::make_alignment;
using testing::make_node;
using testing::random_bytes;

const AgentId kDistantPeer = agent("robot-08");

graph::Alignment ambiguous() {
  graph::Alignment alignment = make_alignment({kSelf, 7}, {kDistantPeer, 3}, kDistantPeer, 9);
  for (std::size_t k = 1; k < graph::Alignment::kMaxModes; ++k) {
    alignment.modes.push_back(alignment.modes.front());
    alignment.modes.back().T_i_j.translation().y() = 0.1 * static_cast<double>(k);
    alignment.modes.back().covariance(2, 3) = -0.01 * static_cast<double>(k);
  }
  return alignment;
}

TEST(ItemCodec, ANodeComesBackBitForBit) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    graph::Node node = make_node(kDistantPeer, seed, random_bytes(9, seed), 12.3, seed);
    node.session = 4711;
    if (seed % 3 == 0) node.G.reset();
    if (seed % 4 == 0) node.descriptor.clear();
    const auto again = decode_node(encode(node));
    ASSERT_TRUE(again) << seed;
    EXPECT_EQ(again->id, node.id);
    EXPECT_EQ(again->session, node.session);
    EXPECT_EQ(again->stamp, node.stamp);
    ASSERT_EQ(again->G.has_value(), node.G.has_value());
    if (node.G) {
      EXPECT_EQ(again->G->stamp, node.G->stamp);
      EXPECT_EQ(again->G->position, node.G->position);
      EXPECT_EQ(again->G->q_enu_base.coeffs(), node.G->q_enu_base.coeffs());
      EXPECT_EQ(again->G->covariance, node.G->covariance);
    }
    EXPECT_EQ(again->up_in_base, node.up_in_base);
    EXPECT_EQ(again->descriptor, node.descriptor);
    EXPECT_EQ(again->T_odom_base.matrix(), node.T_odom_base.matrix());
    EXPECT_EQ(again->odom_covariance, node.odom_covariance);
    EXPECT_EQ(again->submap_hash, node.submap_hash);
    EXPECT_EQ(again->submap_bytes, node.submap_bytes);
  }
}

TEST(ItemCodec, AnAlignmentComesBackBitForBit) {
  const graph::Alignment alignment = ambiguous();
  const auto again = decode_alignment(encode(alignment));
  ASSERT_TRUE(again);
  EXPECT_EQ(again->i, alignment.i);
  EXPECT_EQ(again->j, alignment.j);
  EXPECT_EQ(again->computed_by, alignment.computed_by);
  EXPECT_EQ(again->seq, alignment.seq);
  ASSERT_EQ(again->modes.size(), alignment.modes.size());
  for (std::size_t k = 0; k < alignment.modes.size(); ++k) {
    EXPECT_EQ(again->modes[k].T_i_j.matrix(), alignment.modes[k].T_i_j.matrix());
    EXPECT_EQ(again->modes[k].rmse, alignment.modes[k].rmse);
    EXPECT_EQ(again->modes[k].inlier_fraction, alignment.modes[k].inlier_fraction);
    EXPECT_EQ(again->modes[k].score, alignment.modes[k].score);
    EXPECT_EQ(again->modes[k].covariance, alignment.modes[k].covariance);
  }
}

TEST(ItemCodec, NumbersThatAreNoneKeepTheirBits) {
  graph::Alignment alignment = make_alignment({kSelf, 0}, {kDistantPeer, 4}, kSelf, 0);
  alignment.modes[0].rmse = -0.0;
  alignment.modes[0].score = std::numeric_limits<double>::quiet_NaN();
  alignment.modes[0].inlier_fraction = -std::numeric_limits<double>::infinity();
  const auto again = decode_alignment(encode(alignment));
  ASSERT_TRUE(again);
  EXPECT_TRUE(std::signbit(again->modes[0].rmse));
  EXPECT_TRUE(std::isnan(again->modes[0].score));
  EXPECT_EQ(encode(*again), encode(alignment));
}

TEST(ItemCodec, RowsOfOlderStoresBeginLikeThis) {
  graph::Node node = make_node(kSelf, 0x01020304, {});
  node.session = 0x0506;
  node.stamp = stamp_from_ns(0x1122334455667788);
  node.G.reset();
  node.up_in_base = {1.0, 0.0, 0.0};
  const Bytes begin{2,    'r',  '1',  4,    3, 2, 1, 6, 5, 0x88, 0x77, 0x66, 0x55,
                    0x44, 0x33, 0x22, 0x11, 0, 0, 0, 0, 0, 0,    0,    0xf0, 0x3f};
  const Bytes bytes = encode(node);
  EXPECT_EQ(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(begin.size())), begin);
  // Pose, covariance, hash, size behind up and the descriptor.
  EXPECT_EQ(bytes.size(), 18 + 24 + 1 + node.descriptor.size() + 96 + 288 + 16 + 4);
}

TEST(ItemCodec, TheSignatureIsNoPartOfTheItem) {
  graph::Node node = make_node(kSelf, 1, {});
  graph::Alignment alignment = ambiguous();
  const Bytes plain_node = encode(node), plain_alignment = encode(alignment);
  node.signature.emplace().fill(1);
  alignment.signature.emplace().fill(1);
  EXPECT_EQ(encode(node), plain_node);
  EXPECT_EQ(encode(alignment), plain_alignment);
}

TEST(ItemCodec, AnyOtherLengthIsRefused) {
  Bytes node = encode(make_node(kSelf, 1, {})), alignment = encode(ambiguous());
  for (std::size_t length = 0; length < node.size(); ++length)
    EXPECT_FALSE(decode_node(ByteView(node).first(length))) << length;
  for (std::size_t length = 0; length < alignment.size(); ++length)
    EXPECT_FALSE(decode_alignment(ByteView(alignment).first(length))) << length;
  node.push_back(0);
  alignment.push_back(0);
  EXPECT_FALSE(decode_node(node));
  EXPECT_FALSE(decode_alignment(alignment));
}

TEST(ItemCodec, CountsAndNamesBeyondTheirRulesAreRefused) {
  graph::Alignment alignment = ambiguous();
  alignment.modes.push_back(alignment.modes.front());
  EXPECT_FALSE(decode_alignment(encode(alignment))) << "seven modes";
  alignment.modes.clear();
  EXPECT_FALSE(decode_alignment(encode(alignment))) << "no mode";
  EXPECT_FALSE(decode_node(encode(graph::Node{}))) << "no name";
  Bytes node = encode(make_node(kSelf, 1, {}));
  node[1] = 'R';
  EXPECT_FALSE(decode_node(node));
  node[1] = 'r';
  ASSERT_TRUE(decode_node(node));
  graph::Node without = make_node(kSelf, 1, {});
  without.G.reset();
  node = encode(without);
  ASSERT_EQ(node[17], 0) << "no G";
  node[17] = 2;
  EXPECT_FALSE(decode_node(node));
}

/// Else two rows of equal items could differ.
TEST(ItemCodec, DecodedItemsEncodeToTheSameBytes) {
  std::mt19937 random(3);
  const Bytes node = encode(make_node(kDistantPeer, 1, {})), alignment = encode(ambiguous());
  int decoded = 0;
  for (int k = 0; k < 20'000; ++k) {
    Bytes damaged = k % 2 == 0 ? node : alignment;
    for (int flips = 0; flips < 3; ++flips)
      damaged[random() % damaged.size()] ^= static_cast<std::uint8_t>(1u << random() % 8);
    const auto as_node = decode_node(damaged);
    const auto as_alignment = decode_alignment(damaged);
    if (as_node) {
      ASSERT_EQ(encode(*as_node), damaged);
    }
    if (as_alignment) {
      ASSERT_EQ(encode(*as_alignment), damaged);
    }
    decoded += as_node || as_alignment ? 1 : 0;
  }
  EXPECT_GT(decoded, 10'000);
}

}  // namespace
}  // namespace fleetmap::store
