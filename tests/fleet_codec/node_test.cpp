#include "fleetmap/graph/node.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fleetmap/fleet_codec/messages.hpp"
#include "random_messages.hpp"
#include "wire_bytes.hpp"

namespace fleetmap::fleet_codec {
namespace {

using fleet_codec::testing::node_id;
using fleet_codec::testing::WireBytes;
using ::testing::HasSubstr;

constexpr std::uint32_t kSeq = (4711u << 16) + 9;

/// A node whose numbers lie on steps of the wire.
graph::Node simple_node() {
  graph::Node node;
  node.id = node_id("robot-01", kSeq);
  node.session = 4711;
  node.stamp = stamp_from_ns(1'700'000'000'123'456'789);
  node.T_odom_base =
      make_pose(rotation_from_rpy(0.0, 0.0, std::numbers::pi * 1000.0 / 32767.0), {1.5, -2.25, 0.125});
  node.odom_covariance = 0.25 * Matrix6d::Identity();
  node.submap_hash.fill(0xab);
  node.submap_bytes = 12345;
  return node;
}

WireBytes wire_before_fix() {
  constexpr std::uint16_t kHalf = 0x3800;  // 0.5 as a half float
  std::array<std::uint16_t, 21> root{};
  for (const std::size_t diagonal : {0u, 2u, 5u, 9u, 14u, 20u}) root[diagonal] = kHalf;
  WireBytes wire;
  wire.octet(kSchemaVersion).name("robot-01").numbers(std::array<std::int16_t, 3>{0, 0, 32767});
  wire.number(std::int64_t{1'700'000'000'123'456'789}).u32(kSeq).f32(1.5f).f32(-2.25f).f32(0.125f);
  wire.u32(12345).octets(16, 0xab).numbers(std::array<std::int16_t, 3>{0, 0, 1000}).numbers(root);
  return wire;
}

WireBytes& add_fix(WireBytes& wire) {
  wire.f64(0.85).f64(-0.15).f32(110.5f).numbers(std::array<std::int16_t, 3>{2000, 0, 0});
  // 1e-4 times two to the power of 5, 6 and 8; then of 3 and 10.
  return wire.numbers(std::array<std::uint16_t, 3>{10240, 12288, 16384})
      .octet(48)
      .octet(160)
      .number(std::int8_t{-32});
}

void set_fix(graph::Node& node) {
  GlobalPose& G = node.G.emplace();
  G.stamp = node.stamp;
  G.position = {0.85, -0.15, 110.5};
  G.q_enu_base = rotation_from_rpy(std::numbers::pi * 2000.0 / 32767.0, 0.0, 0.0);
  Vector6d stddev;
  stddev << 32e-4, 64e-4, 256e-4, 8e-4, 8e-4, 1024e-4;
  G.covariance = stddev.cwiseAbs2().asDiagonal();
  G.covariance(0, 1) = G.covariance(1, 0) = -32.0 / 127.0 * 32e-4 * 64e-4;
}

TEST(NodeCodec, LiesOnTheWireAsTheIdlHasIt) {
  graph::Node node = simple_node();
  EXPECT_EQ(encode(node), wire_before_fix().u32(0).u32(0).u32(0).bytes());
  set_fix(node);
  node.descriptor = Bytes(5, 7);
  node.signature.emplace().fill(9);
  WireBytes wire = wire_before_fix();
  add_fix(wire.u32(1)).u32(5).octets(5, 7).u32(64).octets(64, 9);
  EXPECT_EQ(encode(node), wire.bytes());
}

TEST(NodeCodec, IsReadFromTheWire) {
  WireBytes wire = wire_before_fix();
  const auto node = decode<graph::Node>(add_fix(wire.u32(1)).u32(2).octets(2, 7).u32(0).bytes());
  ASSERT_TRUE(node) << node.error().message;
  graph::Node expected = simple_node();
  set_fix(expected);
  EXPECT_EQ(node->id, expected.id);
  EXPECT_EQ(node->session, 4711) << "the upper half of the number";
  EXPECT_EQ(node->stamp, expected.stamp);
  EXPECT_EQ(node->descriptor, Bytes(2, 7));
  EXPECT_EQ(node->submap_hash, expected.submap_hash);
  EXPECT_EQ(node->submap_bytes, 12345u);
  EXPECT_EQ(node->up_in_base, Eigen::Vector3d::UnitZ());
  EXPECT_TRUE(node->T_odom_base.isApprox(expected.T_odom_base, 1e-12));
  EXPECT_TRUE(node->odom_covariance.isApprox(expected.odom_covariance, 1e-12));
  EXPECT_FALSE(node->signature);
  ASSERT_TRUE(node->G);
  EXPECT_EQ(node->G->stamp, node->stamp);
  EXPECT_EQ(node->G->position, expected.G->position);
  EXPECT_TRUE(node->G->q_enu_base.isApprox(expected.G->q_enu_base, 1e-12));
  EXPECT_TRUE(node->G->covariance.isApprox(expected.G->covariance, 1e-9));
}

TEST(NodeCodec, MeanVarianceOfTheTiltsIsKept) {
  graph::Node node = simple_node();
  set_fix(node);
  node.G->covariance(3, 3) = 2e-4 * 2e-4;
  node.G->covariance(4, 4) = 14.0e-8 * 2.0 - 4e-8;  // the mean is 14e-8
  node.G->covariance(3, 5) = node.G->covariance(5, 3) = 1e-6;
  const auto kept = quantised(node);
  ASSERT_TRUE(kept) << kept.error().message;
  const Matrix6d& C = kept->G->covariance;
  EXPECT_EQ(C(3, 3), C(4, 4));
  EXPECT_NEAR(C(3, 3), 14e-8, 0.045 * 14e-8);
  EXPECT_EQ(C(3, 5), 0.0);
}

TEST(NodeCodec, InvalidNodeIsRefusedWithTheReason) {
  const auto refusal = [](const Bytes& bytes) {
    const auto node = decode<graph::Node>(bytes);
    return node ? "none" : node.error().message;
  };
  WireBytes two_fixes = wire_before_fix();
  add_fix(two_fixes.u32(2));
  EXPECT_THAT(refusal(add_fix(two_fixes).u32(0).u32(0).bytes()),
              HasSubstr("Node: there is more than one fix"));
  graph::Node node = simple_node();
  node.submap_bytes = kMaxSubmapBytes;
  EXPECT_EQ(refusal(encode(node)), "none");
  node.submap_bytes += 1;
  EXPECT_THAT(refusal(encode(node)), HasSubstr("submap_bytes is beyond 64 MiB"));
  node = simple_node();
  node.id.seq = kEndOfSeqs;
  EXPECT_THAT(refusal(encode(node)), HasSubstr("agent: sequence number 4294901760 is too large"));
  node = simple_node();
  node.T_odom_base.translation().y() = 1.01e7;
  EXPECT_THAT(refusal(encode(node)), HasSubstr("odom_translation is not finite or beyond its range"));
  node = simple_node();
  node.T_odom_base.linear().setConstant(std::nan(""));
  EXPECT_THAT(refusal(encode(node)), HasSubstr("odom_rotation is not a rotation vector within pi"));
  set_fix(node = simple_node());
  node.G->position.latitude = std::nan("");
  EXPECT_THAT(refusal(encode(node)), HasSubstr("position is not on Earth"));
}

}  // namespace
}  // namespace fleetmap::fleet_codec
