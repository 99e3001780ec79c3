#include "fleetmap/fleet_codec/messages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "fleetmap/fleet_codec/topics.hpp"
#include "random_messages.hpp"

namespace fleetmap::fleet_codec {
namespace {

using fleet_codec::testing::cloud_fragment;
using fleet_codec::testing::id;
using fleet_codec::testing::node_id;
using fleet_codec::testing::RandomMessages;
using fleet_codec::testing::submap_chunk;
using ::testing::HasSubstr;

double angle_between(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return so3_log(a.transpose() * b).norm();
}

TEST(FleetMessages, DecodingAndEncodingAgainGivesTheSameBytes) {
  RandomMessages random(1);
  for (int k = 0; k < 300; ++k) {
    for (const messages::Message& message : random.one_of_each()) {
      const Bytes bytes = encode(message);
      const auto decoded = decode_message(topic_of(message), bytes);
      ASSERT_TRUE(decoded) << decoded.error().message;
      EXPECT_EQ(decoded->index(), message.index());
      EXPECT_EQ(encode(*decoded), bytes) << topic_of(message).type << " round " << k;
    }
    const Bytes pose = encode(random.global_pose());
    EXPECT_EQ(encode(*decode<GlobalPose>(pose)), pose);
    const Bytes cloud = encode(random.cloud());
    EXPECT_EQ(encode(*decode<messages::SpherizedCloud>(cloud)), cloud);
  }
}

TEST(FleetMessages, NodeKeepsItsMeaningWithinTheStepsOfTheWire) {
  RandomMessages random(2);
  for (int k = 0; k < 300; ++k) {
    const graph::Node node = random.node();
    const auto received = decode<graph::Node>(encode(node));
    ASSERT_TRUE(received) << received.error().message;
    EXPECT_EQ(received->id, node.id);
    EXPECT_EQ(received->session, node.session);
    EXPECT_EQ(received->stamp, node.stamp);
    EXPECT_LT((received->up_in_base - node.up_in_base).norm(), 1e-4);
    EXPECT_EQ(received->descriptor, node.descriptor);
    // Three codes of pi / 32767 each off by at most one half, and one more next to half a turn.
    EXPECT_LT(angle_between(received->T_odom_base.linear(), node.T_odom_base.linear()), 3e-4);
    EXPECT_LT((received->T_odom_base.translation() - node.T_odom_base.translation()).norm(), 2e-4);
    EXPECT_EQ(received->submap_hash, node.submap_hash);
    EXPECT_EQ(received->submap_bytes, node.submap_bytes);
    EXPECT_LT((received->odom_covariance - node.odom_covariance).cwiseAbs().maxCoeff(), 6e-3);
    ASSERT_EQ(received->G.has_value(), node.G.has_value());
    if (!node.G) continue;
    EXPECT_EQ(received->G->stamp, node.stamp);
    EXPECT_EQ(received->G->position.latitude, node.G->position.latitude);
    EXPECT_EQ(received->G->position.longitude, node.G->position.longitude);
    EXPECT_NEAR(received->G->position.altitude, node.G->position.altitude, 1e-3);
    EXPECT_LT(
        angle_between(received->G->q_enu_base.toRotationMatrix(), node.G->q_enu_base.toRotationMatrix()),
        3e-4);
    const Matrix6d &C = node.G->covariance, &R = received->G->covariance;
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(R(axis, axis) / C(axis, axis), 1.0, 1e-3);
    EXPECT_NEAR(R(0, 1), C(0, 1), 9e-3 * std::sqrt(C(0, 0) * C(1, 1)));
    EXPECT_NEAR(R(3, 3) / (0.5 * (C(3, 3) + C(4, 4))), 1.0, 0.045);
    EXPECT_NEAR(R(5, 5) / C(5, 5), 1.0, 0.045);
    EXPECT_GT(R.llt().matrixL().determinant(), 0.0);
  }
}

TEST(FleetMessages, AlignmentKeepsItsMeaningWithinFloat) {
  RandomMessages random(3);
  for (int k = 0; k < 300; ++k) {
    const graph::Alignment alignment = random.alignment();
    const auto received = decode<graph::Alignment>(encode(alignment));
    ASSERT_TRUE(received) << received.error().message;
    EXPECT_EQ(received->i, alignment.i);
    EXPECT_EQ(received->j, alignment.j);
    EXPECT_EQ(received->computed_by, alignment.computed_by);
    EXPECT_EQ(received->seq, alignment.seq);
    ASSERT_EQ(received->modes.size(), alignment.modes.size());
    for (std::size_t m = 0; m < alignment.modes.size(); ++m) {
      const graph::AlignmentMode &got = received->modes[m], &sent = alignment.modes[m];
      EXPECT_LT(angle_between(got.T_i_j.linear(), sent.T_i_j.linear()), 4e-6);
      EXPECT_LT((got.T_i_j.translation() - sent.T_i_j.translation()).norm(), 2e-4);
      EXPECT_NEAR(got.rmse, sent.rmse, 1e-6);
      EXPECT_NEAR(got.inlier_fraction, sent.inlier_fraction, 1e-6);
      EXPECT_NEAR(got.score, sent.score, 1e-6);
      EXPECT_LT((got.covariance - sent.covariance).cwiseAbs().maxCoeff(), 6e-3);
    }
  }
}

TEST(FleetMessages, HalfATurnAboutAnyAxisIsRoundedOnceAndForAll) {
  for (const Eigen::Vector3d& axis :
       {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(1, 0, 0),
        Eigen::Vector3d(0.6, 0.8, 0), Eigen::Vector3d(-0.48, 0.6, 0.64)}) {
    graph::Node node;
    node.id = {id("r1"), 0};
    node.T_odom_base.linear() = so3_exp(std::numbers::pi * axis);
    node.G.emplace().q_enu_base = Eigen::Quaterniond(so3_exp(-std::numbers::pi * axis));
    const auto once = quantised(node);
    ASSERT_TRUE(once) << once.error().message;
    EXPECT_EQ(encode(*quantised(*once)), encode(*once));
    EXPECT_LT(angle_between(once->T_odom_base.linear(), node.T_odom_base.linear()), 3e-4);
  }
}

TEST(FleetMessages, QuantisedIsWhatReceiversHold) {
  RandomMessages random(4);
  graph::Node original = random.node();
  original.G = random.global_pose();
  const graph::Node node = *quantised(original);
  const graph::Node received = *decode<graph::Node>(encode(node));
  EXPECT_TRUE(received.T_odom_base.isApprox(node.T_odom_base, 1e-15));
  EXPECT_EQ(received.G->position, node.G->position);
  EXPECT_TRUE(received.G->covariance.isApprox(node.G->covariance, 1e-12));
  graph::Node broken = node;
  broken.T_odom_base.translation().x() = std::nan("");
  EXPECT_THAT(quantised(broken).error().message, HasSubstr("odom_translation is not finite"));
  broken = node;
  broken.T_odom_base.linear()(0, 0) = std::nan("");
  EXPECT_THAT(quantised(broken).error().message, HasSubstr("odom_rotation is not a rotation vector"));
  broken = node;
  broken.G->position.latitude = 2.0;
  EXPECT_THAT(quantised(broken).error().message, HasSubstr("position is not on Earth"));
}

TEST(FleetMessages, NodeWithoutGlobalPoseHasAFewBytesLess) {
  RandomMessages random(5);
  graph::Node node = random.node();
  node.descriptor = Bytes(graph::Node::kMaxDescriptorBytes, 1);
  node.G = random.global_pose();
  const std::size_t with = encode(node).size();
  EXPECT_LE(with, 424u);
  node.G.reset();
  EXPECT_LT(encode(node).size(), with);
  EXPECT_FALSE(quantised(node)->G);
  node.up_in_base = Eigen::Vector3d::Constant(std::nan(""));
  EXPECT_THAT(quantised(node).error().message, HasSubstr("up_in_base"));
  node.up_in_base = Eigen::Vector3d::Zero();
  EXPECT_THAT(quantised(node).error().message, HasSubstr("up_in_base"));
  node.up_in_base = {0.0, 0.0, -1.0};
  node.descriptor.push_back(1);
  EXPECT_EQ(quantised(node)->descriptor.size(), graph::Node::kMaxDescriptorBytes);
}

TEST(FleetMessages, MissionReportKeepsItsMeaning) {
  messages::MissionReport report;
  report.from = id("r1");
  report.stamp = stamp_from_ns(5);
  report.state = messages::MissionState::kLowBattery;
  report.position = {-12.3, 4567.8};
  report.battery = 0.3;
  report.current = 9;
  report.done = messages::RowSet(20);
  report.done.set(19);
  report.claimed = messages::RowSet(20);
  report.claimed.set(9);
  report.failed = messages::RowSet(20);
  report.failed.set(3);
  const auto received = decode<messages::MissionReport>(encode(report));
  ASSERT_TRUE(received) << received.error().message;
  EXPECT_EQ(received->from, report.from);
  EXPECT_EQ(received->stamp, report.stamp);
  EXPECT_EQ(received->state, report.state);
  EXPECT_NEAR((received->position - report.position).norm(), 0.0, 5e-4);
  EXPECT_NEAR(received->battery, report.battery, 1e-7);
  EXPECT_EQ(received->current, report.current);
  EXPECT_EQ(received->done, report.done);
  EXPECT_EQ(received->claimed, report.claimed);
  EXPECT_EQ(received->failed, report.failed);
  report.battery = 1.02;  // as some drivers report of a full one
  EXPECT_EQ(decode<messages::MissionReport>(encode(report))->battery, 1.0);
  report.state = messages::MissionState::kCalledHome;
  EXPECT_EQ(decode<messages::MissionReport>(encode(report))->state, report.state);
  report.state = static_cast<messages::MissionState>(7);
  EXPECT_FALSE(decode<messages::MissionReport>(encode(report)));
}

TEST(FleetMessages, SizesOnTheWire) {
  RandomMessages random(5);
  for (int k = 0; k < 20; ++k) {
    graph::Node node = random.node();
    node.descriptor.clear();
    node.G.reset();
    node.signature.reset();
    EXPECT_EQ(encode(node).size(), 124u);
    node.descriptor.resize(graph::Node::kMaxDescriptorBytes);
    EXPECT_EQ(encode(node).size(), 324u);
    node.G = random.global_pose();
    EXPECT_EQ(encode(node).size(), 360u);
    node.signature = random.signature();
    EXPECT_EQ(encode(node).size(), 424u);
    graph::Alignment alignment = random.alignment();
    alignment.signature.reset();
    alignment.modes.resize(1);
    EXPECT_EQ(encode(alignment).size(), 132u);
    alignment.modes.resize(graph::Alignment::kMaxModes + 3);
    EXPECT_EQ(encode(alignment).size(), 532u) << "more modes than the bound are cut";
    alignment.modes.resize(1);
    alignment.signature = random.signature();
    EXPECT_EQ(encode(alignment).size(), 196u);
  }
  const auto full = cloud_fragment(25000, 0, 23, 1100);
  EXPECT_EQ(encode(full).size(), 1164u);
  const auto chunk = submap_chunk(0, 100000, 8192);
  EXPECT_EQ(encode(chunk).size(), 8240u);
  EXPECT_EQ(encode(messages::ProximityMatch{}).size(), 56u);
  EXPECT_EQ(encode(messages::CloudRequest{}).size(), 44u);
  EXPECT_EQ(encode(messages::AgentStatus{}).size(), 84u);
  messages::MissionReport report;
  report.done = report.claimed = report.failed = messages::RowSet(200);
  EXPECT_EQ(encode(report).size(), 137u);
  EXPECT_EQ(encode(messages::SubmapRequest{}).size(), 44u);
  const SeqRange range{id("r1"), 0, 9};
  EXPECT_EQ(encode(messages::Digest{id("r1"), {range, range}, {range}, {1, 2}, {3}}).size(), 32u + 3 * 20u);
  EXPECT_EQ(encode(messages::SubmapDigest{id("r1"), {range, range}, {id("r2")}}).size(), 24u + 2 * 16u + 8u);
  EXPECT_EQ(encode(messages::SpherizedCloud{node_id("r1", 1), 20, 0.1, 9, Bytes(kMaxCloudPayload)}).size(),
            kMaxEncodedCloud);
}

TEST(FleetMessages, LongListsAreCutToTheirBoundAndStillReadable) {
  messages::Digest digest{id("r1"), {}, {}};
  for (std::uint32_t k = 0; k < 1000; ++k) {
    digest.nodes.push_back({id("r2"), 2 * k, 2 * k + 1});
    digest.node_prints.push_back(k);
  }
  const auto received = decode<messages::Digest>(encode(digest));
  ASSERT_TRUE(received) << received.error().message;
  ASSERT_EQ(received->nodes.size(), kMaxRanges);
  EXPECT_EQ(received->nodes.back(), digest.nodes[kMaxRanges - 1]);
  EXPECT_EQ(received->node_prints.back(), kMaxRanges - 1);
}

TEST(FleetMessages, BothByteOrdersAreRead) {
  messages::SubmapRequest request{id("r1"), id("r2"), node_id("r3", 7), 1000, 2000};
  Bytes bytes = encode(request);
  bytes[1] = 0;  // big-endian
  for (const std::size_t at : {32u, 36u, 40u}) std::reverse(bytes.begin() + at, bytes.begin() + at + 4);
  const auto received = decode<messages::SubmapRequest>(bytes);
  ASSERT_TRUE(received) << received.error().message;
  EXPECT_EQ(received->node, request.node);
  EXPECT_EQ(received->offset, 1000u);
  EXPECT_EQ(received->length, 2000u);
}

}  // namespace
}  // namespace fleetmap::fleet_codec
