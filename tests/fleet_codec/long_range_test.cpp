#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fleetmap/fleet_codec/messages.hpp"
#include "random_messages.hpp"
#include "wire_bytes.hpp"

namespace fleetmap::fleet_codec {
namespace {

using Kind = messages::HoldOrder::Kind;
using fleet_codec::testing::cloud_fragment;
using fleet_codec::testing::id;
using fleet_codec::testing::node_id;
using fleet_codec::testing::refusal;
using fleet_codec::testing::WireBytes;
using ::testing::HasSubstr;

template <class T>
T read(const WireBytes& wire) {
  const auto decoded = decode<T>(wire.bytes());
  EXPECT_TRUE(decoded) << decoded.error().message;
  return decoded.value_or(T{});
}

TEST(LongRange, AMatchLiesOnTheWireAsTheIdlHasIt) {
  const messages::ProximityMatch match{id("r1"), id("r2"), node_id("r3", 7), node_id("r1", 9), 1.5, 12.25};
  WireBytes wire;
  wire.octet(kSchemaVersion).name("r1").name("r2").name("r3").u32(7).name("r1").u32(9).f32(1.5f).f32(12.25f);
  EXPECT_EQ(encode(match), wire.bytes());
  const auto got = read<messages::ProximityMatch>(wire);
  EXPECT_EQ(got.from, match.from);
  EXPECT_EQ(got.to, match.to);
  EXPECT_EQ(got.theirs, match.theirs);
  EXPECT_EQ(got.ours, match.ours);
  EXPECT_EQ(got.distance, 1.5);
  EXPECT_EQ(got.radius, 12.25);
}

TEST(LongRange, CloudsAndTheirPiecesLieOnTheWireAsTheIdlHasThem) {
  const messages::SpherizedCloud cloud{node_id("r3", 7), 20.0, 0.25, 300, Bytes(2, 5)};
  WireBytes whole;
  whole.octet(kSchemaVersion).name("r3").u32(7).f32(20.0f).f32(0.25f).u32(300).u32(2).octets(2, 5);
  EXPECT_EQ(encode(cloud), whole.bytes());
  EXPECT_EQ(read<messages::SpherizedCloud>(whole).points, 300u);
  messages::CloudFragment piece{id("r1"), id("r2"), node_id("r3", 7), {}, 1103, 1, 2, Bytes(3, 5)};
  piece.cloud_hash.fill(0xcd);
  WireBytes part;
  part.octet(kSchemaVersion).name("r1").name("r2").name("r3").u32(7).octets(16, 0xcd).u32(1103);
  part.number(std::uint16_t{1}).number(std::uint16_t{2}).u32(3).octets(3, 5);
  EXPECT_EQ(encode(piece), part.bytes());
  const auto got = read<messages::CloudFragment>(part);
  EXPECT_EQ(got.cloud_hash, piece.cloud_hash);
  EXPECT_EQ(got.payload, piece.payload);
  messages::CloudRequest request{id("r1"), id("r2"), node_id("r3", 7), {4, 1099}, 2.5f};
  WireBytes asked;
  asked.octet(kSchemaVersion).name("r1").name("r2").name("r3").u32(7).f32(2.5f).u32(2);
  asked.number(std::uint16_t{4}).number(std::uint16_t{1099});
  EXPECT_EQ(encode(request), asked.bytes());
  EXPECT_EQ(read<messages::CloudRequest>(asked).missing, request.missing);
  EXPECT_EQ(read<messages::CloudRequest>(asked).information, 2.5f);
}

TEST(LongRange, DigestsAndRequestsOfItemsLieOnTheWireAsTheIdlHasThem) {
  const std::vector<SeqRange> nodes{{id("r1"), 0, 9}, {id("r2"), 65536, 65538}}, alignments{{id("r3"), 4, 5}};
  WireBytes wire;
  wire.octet(kSchemaVersion).name("r1").u32(2).name("r1").u32(0).u32(9).name("r2").u32(65536).u32(65538);
  wire.u32(1).name("r3").u32(4).u32(5).u32(2).u32(77).u32(88).u32(1).u32(99);
  EXPECT_EQ(encode(messages::Digest{id("r1"), nodes, alignments, {77, 88}, {99}}), wire.bytes());
  const auto digest = read<messages::Digest>(wire);
  EXPECT_EQ(digest.nodes, nodes);
  EXPECT_EQ(digest.alignments, alignments);
  EXPECT_EQ(digest.node_prints, (std::vector<std::uint32_t>{77, 88}));
  EXPECT_EQ(digest.alignment_prints, (std::vector<std::uint32_t>{99}));
  WireBytes asked;
  asked.octet(kSchemaVersion).name("r1").name("r2").u32(1).name("r3").u32(4).u32(5).u32(0);
  EXPECT_EQ(encode(messages::ItemRequest{id("r1"), id("r2"), alignments, {}}), asked.bytes());
  EXPECT_EQ(read<messages::ItemRequest>(asked).nodes, alignments);
}

TEST(LongRange, AStatusLiesOnTheWireAsTheIdlHasIt) {
  const messages::AgentStatus status{
      id("r1"), stamp_from_ns(123456789012),          {0.5, -0.25, 110.5}, 1.5f, 0.75f, -1.0f, 1, 2, 3, 4,
      true,     {{id("r2"), 500}, {id("r3"), 65535}}, {17, 3, -9}};
  WireBytes wire;
  wire.octet(kSchemaVersion).name("r1").number(std::int64_t{123456789012}).f64(0.5).f64(-0.25).f32(110.5f);
  wire.f32(1.5f).f32(0.75f).f32(-1.0f).u32(1).u32(2).u32(3).u32(4).octet(1).octet(17).octet(3).octet(0xf7);
  wire.u32(2).name("r2").number(std::uint16_t{500}).name("r3").number(std::uint16_t{65535});
  EXPECT_EQ(encode(status), wire.bytes());
  const auto got = read<messages::AgentStatus>(wire);
  EXPECT_EQ(got.stamp, status.stamp);
  EXPECT_EQ(got.position, status.position);
  EXPECT_EQ(got.heading, 1.5f);
  EXPECT_EQ(got.position_stddev, 0.75f);
  EXPECT_EQ(got.battery, -1.0f) << "unknown";
  EXPECT_EQ(got.nodes, 1u);
  EXPECT_EQ(got.alignments, 2u);
  EXPECT_EQ(got.submaps, 3u);
  EXPECT_EQ(got.backlog_bytes, 4u);
  EXPECT_TRUE(got.busy);
  EXPECT_EQ(got.loans, status.loans);
  EXPECT_EQ(got.health, status.health);
  messages::AgentStatus well = status;
  well.health = {};
  EXPECT_EQ(encode(well).size(), encode(status).size()) << "health lies where alignment left bytes unused";
}

TEST(LongRange, AMissionReportLiesOnTheWireAsTheIdlHasIt) {
  messages::MissionReport report;
  report.from = id("r1");
  report.stamp = stamp_from_ns(123456789012);
  report.state = messages::MissionState::kStuck;
  report.position = {-12.5, 4567.75};
  report.battery = 0.25;
  report.current = 9;
  report.done = messages::RowSet(Bytes{1, 2});
  report.claimed = messages::RowSet(Bytes{4});
  WireBytes wire;
  wire.octet(kSchemaVersion).name("r1").octet(3).number(std::int64_t{123456789012}).f32(-12.5f).f32(4567.75f);
  wire.f32(0.25f).u32(9).u32(2).octet(1).octet(2).u32(1).octet(4).u32(0);
  EXPECT_EQ(encode(report), wire.bytes());
  EXPECT_TRUE(read<messages::MissionReport>(wire).claimed.has(2));
}

TEST(LongRange, OrdersToHoldLieOnTheWireAsTheIdlHasThem) {
  const messages::Hold hold{id("op"),
                            messages::Hold::Driving::kHeld,
                            {{stamp_from_ns(12345678901), {}, id("op"), Kind::kHold},
                             {stamp_from_ns(2), id("r2"), id("o2"), Kind::kHome}},
                            {{stamp_from_ns(3), id("r1"), {}, id("op"), 70}}};
  WireBytes wire;
  wire.octet(kSchemaVersion).octet(2).name("op").u32(2);
  wire.number(std::int64_t{12345678901}).name("").name("op").octet(1);
  wire.number(std::int64_t{2}).name("r2").name("o2").octet(2);
  wire.u32(1).number(std::int64_t{3}).name("r1").name("").name("op").u32(70);
  EXPECT_EQ(encode(hold), wire.bytes());
  const auto got = read<messages::Hold>(wire);
  EXPECT_EQ(got.driving, hold.driving);
  EXPECT_EQ(got.orders, hold.orders) << "the first one of all robots";
  EXPECT_EQ(got.rows, hold.rows) << "to any other robot";
}

TEST(LongRange, MeaninglessValuesAreRefusedWithTheReason) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  messages::ProximityMatch match{id("r1"), id("r2"), node_id("r3", 7), node_id("r1", 9), -0.5, 1.0};
  EXPECT_THAT(refusal(match), HasSubstr("ProximityMatch: distance is negative, not finite or too large"));
  match.distance = 1.0;
  match.radius = kNan;
  EXPECT_THAT(refusal(match), HasSubstr("radius is negative, not finite or too large"));
  messages::SpherizedCloud cloud{node_id("r3", 7), 20.0, 0.25, 255 * 4, Bytes(4)};
  EXPECT_EQ(refusal(cloud), "none");
  cloud.points += 1;
  EXPECT_THAT(refusal(cloud), HasSubstr("points are more than the payload can hold"));
  cloud.points = 0;
  cloud.voxel = -0.1;
  EXPECT_THAT(refusal(cloud), HasSubstr("voxel is negative"));
  messages::CloudRequest request{id("r1"), id("r2"), node_id("r3", 7), {}, 1001.0f};
  EXPECT_THAT(refusal(request), HasSubstr("information is negative, not finite or too large"));
  messages::AgentStatus status;
  status.from = id("r1");
  EXPECT_EQ(refusal(status), "none");
  status.battery = 1.5f;
  EXPECT_THAT(refusal(status), HasSubstr("battery is not finite or beyond its range"));
  status.battery = 1.0f;
  status.heading = 11.0f;
  EXPECT_THAT(refusal(status), HasSubstr("heading is not finite or beyond its range"));
  status.heading = 0.0f;
  status.health = {32, 0, 0};
  EXPECT_THAT(refusal(status), HasSubstr("problems are not known"));
  status.health = {0, 4, 0};
  EXPECT_THAT(refusal(status), HasSubstr("clock_sensor is not known"));
  messages::MissionReport report;
  report.from = id("r1");
  report.position.x() = 3e7;
  EXPECT_THAT(refusal(report), HasSubstr("east is not finite or beyond its range"));
  EXPECT_THAT(refusal(messages::Hold{id("op"), static_cast<messages::Hold::Driving>(5), {}}),
              HasSubstr("driving is not known"));
  EXPECT_THAT(refusal(messages::Hold{id("op"), {}, {{stamp_from_ns(1), id("r2"), {}, Kind::kHold}}}),
              HasSubstr("issuer: agent id"));
  EXPECT_THAT(refusal(messages::Hold{id("op"), {}, {{stamp_from_ns(1), {}, id("op"), static_cast<Kind>(4)}}}),
              HasSubstr("kind of an order is not known"));
  EXPECT_THAT(refusal(messages::Hold{id("op"), {}, {}, {{stamp_from_ns(1), {}, id("r2"), id("op"), 7}}}),
              HasSubstr("robot: agent id"));
}

TEST(LongRange, LongListsAreCutToWhatEveryReceiverTakes) {
  messages::CloudRequest request{id("r1"), id("r2"), node_id("r3", 7), {}, 0.0f};
  for (std::uint16_t k = 0; k < 300; ++k) request.missing.push_back(k);
  const auto missing = decode<messages::CloudRequest>(encode(request))->missing;
  ASSERT_EQ(missing.size(), kMaxMissing);
  EXPECT_EQ(missing.back(), kMaxMissing - 1);
  messages::Hold hold{id("op"), {}, {}};
  for (int k = 0; k < 40; ++k) {
    hold.orders.push_back({stamp_from_ns(k), id("r2"), id("op"), Kind::kHold});
    hold.rows.push_back({stamp_from_ns(k), id("r2"), {}, id("op"), static_cast<std::uint32_t>(k)});
  }
  const auto orders = decode<messages::Hold>(encode(hold))->orders;
  ASSERT_EQ(orders.size(), kMaxHoldOrders);
  EXPECT_EQ(orders.back(), hold.orders[kMaxHoldOrders - 1]);
  EXPECT_EQ(decode<messages::Hold>(encode(hold))->rows.size(), kMaxRowOrders);
  messages::AgentStatus status;
  status.from = id("r1");
  status.loans.assign(9, {id("r2"), 7});
  EXPECT_EQ(decode<messages::AgentStatus>(encode(status))->loans.size(), kMaxLoans);
  messages::ItemRequest items{id("r1"), id("r2"), {}, {}};
  items.alignments.assign(300, {id("r3"), 1, 2});
  EXPECT_EQ(decode<messages::ItemRequest>(encode(items))->alignments.size(), kMaxRanges);
  messages::MissionReport report;
  report.from = id("r1");
  report.done = messages::RowSet(Bytes(600, 0xff));
  EXPECT_EQ(decode<messages::MissionReport>(encode(report))->done.count(), 8 * kMaxRowSet);
}

}  // namespace
}  // namespace fleetmap::fleet_codec
