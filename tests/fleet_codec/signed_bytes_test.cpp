#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "fleetmap/fleet_codec/messages.hpp"
#include "random_messages.hpp"

namespace fleetmap::fleet_codec {
namespace {

using fleet_codec::testing::RandomMessages;
using ::testing::HasSubstr;

/// As a processor whose sine, exponential or fused product rounds otherwise decodes it.
void change_last_bits(RandomMessages& random, Eigen::Ref<Eigen::MatrixXd> numbers) {
  numbers = numbers.unaryExpr([&](double x) { return x * (1.0 + random.real(-4e-16, 4e-16)); });
}

Matrix6d elsewhere(RandomMessages& random, Matrix6d C) {
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column)
      C(column, row) = C(row, column) *= 1.0 + random.real(-4e-16, 4e-16);
  }
  return C;
}

Pose elsewhere(RandomMessages& random, const Pose& T) {
  Eigen::MatrixXd R = T.linear();
  change_last_bits(random, R);
  return make_pose(R, T.translation());
}

TEST(SignedBytes, SignedBytesAreTheSameOnEveryProcessor) {
  RandomMessages random(11);
  for (int k = 0; k < 2000; ++k) {
    graph::Node made = *quantised(random.node());
    // As of an odometry that knows two axes alone: what is zero stays zero.
    if (k % 3 == 0) {
      made.odom_covariance.bottomRows(4).setZero();
      made.odom_covariance.rightCols(4).setZero();
      made = *quantised(made);
    }
    made.signature = random.signature();
    graph::Node held = *decode<graph::Node>(encode(made));
    EXPECT_EQ(held.signature, made.signature);
    held.T_odom_base = elsewhere(random, held.T_odom_base);
    held.odom_covariance = elsewhere(random, held.odom_covariance);
    if (held.G) {
      Eigen::MatrixXd q = held.G->q_enu_base.coeffs();
      change_last_bits(random, q);
      held.G->q_enu_base.coeffs() = q;
      held.G->covariance = elsewhere(random, held.G->covariance);
    }
    ASSERT_EQ(signed_bytes(held), signed_bytes(made)) << "round " << k;
    graph::Alignment computed = *quantised(random.alignment());
    computed.signature = random.signature();
    graph::Alignment received = *decode<graph::Alignment>(encode(computed));
    EXPECT_EQ(received.signature, computed.signature);
    for (graph::AlignmentMode& mode : received.modes) {
      mode.T_i_j = elsewhere(random, mode.T_i_j);
      mode.covariance = elsewhere(random, mode.covariance);
    }
    ASSERT_EQ(signed_bytes(received), signed_bytes(computed)) << "round " << k;
  }
}

TEST(SignedBytes, SignedBytesHoldNeitherSignatureNorVersionAndAllElse) {
  RandomMessages random(12);
  graph::Node node = random.node();
  node.signature.reset();
  const Bytes bytes = encode(node), to_sign = signed_bytes(node);
  ASSERT_EQ(to_sign.size(), bytes.size());
  EXPECT_EQ(std::ranges::mismatch(bytes, to_sign).in1 - bytes.begin(), 4) << "the version behind the header";
  EXPECT_TRUE(std::equal(bytes.begin() + 5, bytes.end(), to_sign.begin() + 5));
  node.signature = random.signature();
  EXPECT_EQ(signed_bytes(node), to_sign);
  EXPECT_EQ(encode(node).size(), bytes.size() + 64);
  EXPECT_NE(signed_bytes(random.node()), to_sign);
}

/// An up vector that is a little short is rounded to the signed one when it is encoded again.
TEST(SignedBytes, SignedItemsThatDecodeToAnotherContentAreRefused) {
  RandomMessages random(14);
  for (int k = 0; k < 300; ++k) {
    graph::Node node = *quantised(random.node());
    node.signature = random.signature();
    const Bytes bytes = encode(node);
    for (int flip = 0; flip < 40; ++flip) {
      Bytes damaged = bytes;
      damaged[5 + random.integer(0, static_cast<std::uint32_t>(bytes.size()) - 6)] ^=
          static_cast<std::uint8_t>(1u << random.integer(0, 7));
      const auto decoded = decode<graph::Node>(damaged);
      if (!decoded || signed_bytes(*decoded) != signed_bytes(node)) continue;
      graph::Node same = *decoded;
      same.signature = node.signature;
      EXPECT_EQ(encode(same), bytes);
      EXPECT_EQ(same.up_in_base, decode<graph::Node>(bytes)->up_in_base);
      EXPECT_EQ(same.odom_covariance, decode<graph::Node>(bytes)->odom_covariance);
    }
    node.up_in_base = {0.0, 0.0, 1.0};
    Bytes damaged = encode(node);
    const Bytes up{0, 0, 0, 0, 0xff, 0x7f};
    const auto at = std::search(damaged.begin(), damaged.end(), up.begin(), up.end());
    ASSERT_NE(at, damaged.end());
    *(at + 4) ^= 0x40;
    EXPECT_FALSE(decode<graph::Node>(damaged));
  }
}

/// Else its holder would hand on another content than it holds, and two robots would never agree.
TEST(SignedBytes, UnsignedItemsThatWereDamagedDecodeToWhatCanBeHandedOn) {
  RandomMessages random(15);
  int damaged_items = 0;
  for (int k = 0; k < 300; ++k) {
    graph::Node node = *quantised(random.node());
    node.signature.reset();
    const Bytes bytes = encode(node);
    for (int flip = 0; flip < 40; ++flip) {
      Bytes damaged = bytes;
      damaged[5 + random.integer(0, static_cast<std::uint32_t>(bytes.size()) - 6)] ^=
          static_cast<std::uint8_t>(1u << random.integer(0, 7));
      const auto held = decode<graph::Node>(damaged);
      if (!held) continue;
      ++damaged_items;
      const auto handed_on = decode<graph::Node>(encode(*held));
      ASSERT_TRUE(handed_on);
      EXPECT_EQ(handed_on->up_in_base, held->up_in_base);
      EXPECT_EQ(handed_on->odom_covariance, held->odom_covariance);
      EXPECT_EQ(handed_on->T_odom_base.matrix(), held->T_odom_base.matrix());
    }
  }
  EXPECT_GT(damaged_items, 1000);
}

TEST(SignedBytes, SignaturesOfAnotherLengthAreRefused) {
  RandomMessages random(13);
  graph::Node node = random.node();
  node.signature = random.signature();
  graph::Alignment alignment = random.alignment();
  alignment.signature = random.signature();
  const auto shortened = [](Bytes bytes) {
    bytes[bytes.size() - 65 - 3] = 63;
    bytes.pop_back();
    return bytes;
  };
  EXPECT_THAT(decode<graph::Node>(shortened(encode(node))).error().message, HasSubstr("has not 64 bytes"));
  EXPECT_THAT(decode<graph::Alignment>(shortened(encode(alignment))).error().message,
              HasSubstr("has not 64 bytes"));
}

}  // namespace
}  // namespace fleetmap::fleet_codec
