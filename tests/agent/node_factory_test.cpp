#include "fleetmap/agent/node_factory.hpp"

#include <gtest/gtest.h>

#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "support/robots.hpp"

namespace fleetmap::agent {
namespace {

using fleetmap::testing::kSelf;
using fleetmap::testing::kStart;
using namespace std::chrono_literals;

constexpr std::uint16_t kSession = 4711;

NodeId name(std::uint32_t k) { return {kSelf, first_seq(kSession) + k}; }

/// A scan at x metres ahead of the start, with a wall two metres ahead of the robot.
ScanEstimate scan_at(double x, bool located = true) {
  ScanEstimate estimate;
  estimate.odometry.stamp = kStart + from_seconds(x);
  estimate.odometry.T_odom_base.translation().x() = x;
  estimate.odometry.covariance = 1e-4 * Matrix6d::Identity();
  for (int k = 0; k < 50; ++k)
    estimate.odometry.points.points.push_back({2.0f, 0.2f * static_cast<float>(k), 0.0f});
  if (located) {
    estimate.G.emplace();
    estimate.G->stamp = estimate.odometry.stamp;
    estimate.G->position = geo_point_from_degrees(48.0, 11.0, 500.0);
    estimate.G->covariance = Matrix6d::Identity();
  }
  return estimate;
}

class NodeFactoryTest : public ::testing::Test {
 protected:
  bool add(double x, bool located = true) {
    return factory_.add(scan_at(x, located), kStart + from_seconds(x));
  }
  std::size_t points_of(const NodeFactory::Made& made) const { return cloud::decode(made.submap)->size(); }
  NodeFactory factory_{kSelf, SubmapConfig{}, place::NodeGeneratorConfig{.spacing = 5.0}};
};

TEST_F(NodeFactoryTest, ANodeIsDueAtTheFirstScanAndThenEveryDThresh) {
  EXPECT_TRUE(add(0.0));
  for (const double x : {1.0, 2.0, 3.0, 4.0, 5.0}) EXPECT_FALSE(add(x)) << x;
  EXPECT_TRUE(add(5.5));
  EXPECT_FALSE(add(10.0));
}

TEST_F(NodeFactoryTest, TheNodeIsWhatReceiversHoldAndNamesItsSubmap) {
  ASSERT_TRUE(add(0.0));
  const auto made = factory_.make(name(0));
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->node.id, name(0));
  EXPECT_EQ(made->node.session, kSession);
  EXPECT_EQ(made->node.stamp, kStart);
  EXPECT_TRUE(made->node.G);
  EXPECT_EQ(made->node.submap_hash, content_hash(made->submap));
  EXPECT_EQ(made->node.submap_bytes, made->submap.size());
  EXPECT_EQ(points_of(*made), made->points);
  EXPECT_EQ(fleet_codec::encode(*fleet_codec::quantised(made->node)), fleet_codec::encode(made->node));
}

TEST_F(NodeFactoryTest, TheNextNodeBeginsWhereTheLastOneWasStored) {
  ASSERT_TRUE(add(0.0));
  const std::size_t first = factory_.make(name(0))->points;
  // It could not be stored: its points go into the next one.
  ASSERT_TRUE(add(6.0));
  EXPECT_EQ(factory_.make(name(0))->points, 2 * first);
  factory_.restart();
  EXPECT_FALSE(factory_.has_rest());
  ASSERT_TRUE(add(12.0));
  const auto next = factory_.make(name(1));
  EXPECT_EQ(next->points, first);
  EXPECT_NEAR(next->node.odom_covariance(0, 0), 1e-4, 1e-6) << "of one scan since the last node";
}

TEST_F(NodeFactoryTest, AScanThatTheOdometryLostEntersNoNode) {
  ScanEstimate lost = scan_at(0.0);
  lost.odometry.lost = true;
  EXPECT_FALSE(factory_.add(std::move(lost), kStart));
  EXPECT_FALSE(factory_.has_rest());
  EXPECT_FALSE(factory_.make(name(0))) << "there is no scan to make it at";
}

TEST_F(NodeFactoryTest, WithoutAGlobalPoseTheFirstNodeWaitsTenSeconds) {
  EXPECT_FALSE(add(0.0, false));
  EXPECT_FALSE(add(9.9, false));
  EXPECT_TRUE(add(10.0, false));
  EXPECT_FALSE(factory_.make(name(0))->node.G);
  EXPECT_TRUE(add(16.0, false)) << "it waits but once";
}

TEST_F(NodeFactoryTest, AGlobalPoseEndsTheWait) {
  EXPECT_FALSE(add(0.0, false));
  EXPECT_TRUE(add(1.0, true));
}

TEST_F(NodeFactoryTest, ANewFrameHoldsNothingOfTheLastOne) {
  ASSERT_TRUE(add(0.0));
  factory_.begin_frame();
  EXPECT_FALSE(factory_.has_rest());
  EXPECT_FALSE(factory_.make(name(0)));
  EXPECT_TRUE(add(1.0)) << "the first node of the frame";
}

}  // namespace
}  // namespace fleetmap::agent
