#include "fleetmap/graph/alignment.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "fleetmap/fleet_codec/messages.hpp"
#include "random_messages.hpp"
#include "wire_bytes.hpp"

namespace fleetmap::fleet_codec {
namespace {

using fleet_codec::testing::id;
using fleet_codec::testing::node_id;
using fleet_codec::testing::WireBytes;
using ::testing::HasSubstr;

constexpr double kUnit = std::numbers::pi / 2147483647.0;

/// Two modes whose numbers lie on steps of the wire.
graph::Alignment simple_alignment() {
  graph::Alignment alignment{node_id("r1", 7), node_id("robot-08", 65536), id("robot-08"), 3, {}};
  alignment.modes.push_back({make_pose(rotation_from_rpy(0.0, 0.0, 1e9 * kUnit), {1.5, -2.25, 0.125}), 0.25,
                             0.75, 0.5, 0.25 * Matrix6d::Identity()});
  alignment.modes.push_back({Pose::Identity(), 0.5, 0.5, 0.25, 4.0 * Matrix6d::Identity()});
  return alignment;
}

void add_mode(WireBytes& wire, const std::array<float, 6>& numbers, std::int32_t yaw, std::uint16_t stddev) {
  std::array<std::uint16_t, 21> root{};
  for (const std::size_t diagonal : {0u, 2u, 5u, 9u, 14u, 20u}) root[diagonal] = stddev;
  wire.f32(numbers[0]).f32(numbers[1]).f32(numbers[2]).numbers(std::array<std::int32_t, 3>{0, 0, yaw});
  wire.f32(numbers[3]).f32(numbers[4]).f32(numbers[5]).numbers(root);
}

WireBytes wire_of_simple() {
  WireBytes wire;
  wire.octet(kSchemaVersion).name("robot-08").name("r1").name("robot-08").u32(3).u32(7).u32(65536).u32(2);
  add_mode(wire, {1.5f, -2.25f, 0.125f, 0.25f, 0.75f, 0.5f}, 1'000'000'000, 0x3800);  // half floats 0.5 and 2
  add_mode(wire, {0.0f, 0.0f, 0.0f, 0.5f, 0.5f, 0.25f}, 0, 0x4000);
  return wire;
}

TEST(AlignmentCodec, LiesOnTheWireAsTheIdlHasIt) {
  graph::Alignment alignment = simple_alignment();
  EXPECT_EQ(encode(alignment), wire_of_simple().u32(0).bytes());
  alignment.signature.emplace().fill(9);
  EXPECT_EQ(encode(alignment), wire_of_simple().u32(64).octets(64, 9).bytes());
}

TEST(AlignmentCodec, IsReadFromTheWire) {
  const auto alignment = decode<graph::Alignment>(wire_of_simple().u32(64).octets(64, 9).bytes());
  ASSERT_TRUE(alignment) << alignment.error().message;
  const graph::Alignment expected = simple_alignment();
  EXPECT_EQ(alignment->i, expected.i);
  EXPECT_EQ(alignment->j, expected.j);
  EXPECT_EQ(alignment->computed_by, expected.computed_by);
  EXPECT_EQ(alignment->seq, 3u);
  ASSERT_TRUE(alignment->signature);
  EXPECT_EQ(alignment->signature->back(), 9);
  ASSERT_EQ(alignment->modes.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    const graph::AlignmentMode &mode = alignment->modes[k], &made = expected.modes[k];
    EXPECT_TRUE(mode.T_i_j.isApprox(made.T_i_j, 1e-12));
    EXPECT_EQ(mode.rmse, made.rmse);
    EXPECT_EQ(mode.inlier_fraction, made.inlier_fraction);
    EXPECT_EQ(mode.score, made.score);
    EXPECT_TRUE(mode.covariance.isApprox(made.covariance, 1e-12));
  }
}

TEST(AlignmentCodec, TheFirstSixModesAreKept) {
  graph::Alignment alignment = simple_alignment();
  for (int k = 2; k < 9; ++k) {
    alignment.modes.push_back(alignment.modes.back());
    alignment.modes.back().rmse = 0.125 * k;
  }
  const auto kept = quantised(alignment);
  ASSERT_TRUE(kept) << kept.error().message;
  ASSERT_EQ(kept->modes.size(), graph::Alignment::kMaxModes);
  for (std::size_t k = 0; k < kept->modes.size(); ++k)
    EXPECT_EQ(kept->modes[k].rmse, alignment.modes[k].rmse) << k;
}

TEST(AlignmentCodec, QuantisedIsUnsigned) {
  graph::Alignment alignment = simple_alignment();
  alignment.signature.emplace().fill(9);
  EXPECT_FALSE(quantised(alignment)->signature);
}

TEST(AlignmentCodec, InvalidAlignmentIsRefusedWithTheReason) {
  struct Case {
    const char* reason;
    std::function<void(graph::Alignment&)> change;
  };
  const Case cases[] = {
      {"computed_by: agent id", [](graph::Alignment& a) { a.computed_by = {}; }},
      {"agent_i: agent id", [](graph::Alignment& a) { a.i.agent = {}; }},
      {"agent_j: sequence number 4294901760 is too large", [](graph::Alignment& a) { a.j.seq = kEndOfSeqs; }},
      {"seq: sequence number 4294901760 is too large", [](graph::Alignment& a) { a.seq = kEndOfSeqs; }},
      {"nodes i and j are the same", [](graph::Alignment& a) { a.j = a.i; }},
      {"translation is not finite", [](graph::Alignment& a) { a.modes[1].T_i_j.translation().z() = 1.01e7; }},
      {"rotation is not a rotation",
       [](graph::Alignment& a) { a.modes[1].T_i_j.linear()(1, 1) = std::nan(""); }},
      {"rmse is negative, not finite or too large", [](graph::Alignment& a) { a.modes[1].rmse = 1.01e6; }},
      {"inlier_fraction is negative", [](graph::Alignment& a) { a.modes[0].inlier_fraction = 1.001; }},
      {"score is negative", [](graph::Alignment& a) { a.modes[0].score = std::nan(""); }},
  };
  for (const Case& bad : cases) {
    graph::Alignment alignment = simple_alignment();
    bad.change(alignment);
    const auto decoded = decode<graph::Alignment>(encode(alignment));
    ASSERT_FALSE(decoded) << bad.reason;
    EXPECT_THAT(decoded.error().message, HasSubstr(std::string("fleetmap::msg::Alignment: ") + bad.reason));
  }
}

}  // namespace
}  // namespace fleetmap::fleet_codec
