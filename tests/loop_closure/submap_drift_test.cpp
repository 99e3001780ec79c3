#include "fleetmap/loop_closure/submap_drift.hpp"

#include <gtest/gtest.h>

#include "loop_closure/own_sessions.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::loop_closure {
namespace {

const AgentId kOther = *AgentId::parse("r2");

class SubmapDrift : public ::testing::Test {
 protected:
  /// A node of the other robot.
  graph::Node add(std::uint32_t seq, double x, double y) {
    graph::Node node;
    node.id = {kOther, seq};
    node.T_odom_base = make_pose(Eigen::Matrix3d::Identity(), Eigen::Vector3d(x, y, 0.0));
    node.odom_covariance = (1.0 + seq) * Vector6d(1e-4, 4e-4, 1e-4, 1e-6, 1e-6, 1e-6).asDiagonal();
    EXPECT_EQ(store_.put_node(node).value(), store::Put::kAdded);
    return node;
  }

  testing::TemporaryFolder folder_;
  store::Store store_ = std::move(store::Store::open(folder_.path() / "store.db", kSelf).value());
};

TEST_F(SubmapDrift, StopsAreTheNodesAroundWithTheirOwnCovariances) {
  for (std::uint32_t k = 0; k < 10; ++k) add(k, 4.0 * k, 0.0);
  const auto drift = drift_around(store_, *store_.node({kOther, 5}), 9.0);
  ASSERT_EQ(drift.stops.size(), 5u);  // 3 to 7
  EXPECT_NEAR(drift.stops[0].T_cloud_base.translation().x(), -8.0, 1e-9);
  EXPECT_NEAR(drift.stops[2].T_cloud_base.translation().norm(), 0.0, 1e-9);
  for (std::size_t k = 1; k < 5; ++k) {
    EXPECT_EQ(drift.stops[k].step_covariance,
              store_.node({kOther, static_cast<std::uint32_t>(3 + k)})->odom_covariance);
  }
}

TEST_F(SubmapDrift, NodesThatAreNotHeldAreBridged) {
  add(0, 0.0, 0.0);
  const graph::Node last = add(5, 12.0, 0.0);
  const auto drift = drift_around(store_, last, 20.0);
  ASSERT_EQ(drift.stops.size(), 2u);
  EXPECT_NEAR(std::sqrt(drift.stops[1].step_covariance(0, 0) / 12.0), 0.006, 1e-9);
  EXPECT_NEAR(std::sqrt(drift.stops[1].step_covariance(3, 3) / 12.0), 0.0004, 1e-9);
}

}  // namespace
}  // namespace fleetmap::loop_closure
