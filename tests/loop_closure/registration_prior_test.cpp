#include "registration_prior.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fleetmap::loop_closure {
namespace {

const NodeId kTarget{AgentId::parse("r1").value(), 0}, kSource{AgentId::parse("r2").value(), 0};

/// At x metres east, with a variance of `variance` m^2 and rad^2 / 100 of yaw.
graph::Node node_of_variance(const NodeId& id, double x, double variance) {
  graph::Node node;
  node.id = id;
  node.G.emplace();
  node.G->position = LocalFrame(geo_point_from_degrees(48.0, 11.0, 500.0)).to_geo({x, 0.0, 0.0});
  node.G->covariance = Vector6d(variance, variance, variance, 1e-4, 1e-4, 0.01 * variance).asDiagonal();
  return node;
}

TEST(RegistrationPrior, PriorOfPositionsIsTheDifferenceOfBothGlobalPoses) {
  graph::Node a = node_of_variance(kTarget, 0.0, 1.0);
  const graph::Node b = node_of_variance(kSource, 10.0, 3.0);
  a.G->q_enu_base = Eigen::Quaterniond(rotation_from_rpy(0, 0, 1.5707963267948966));
  const registration::Prior prior = position_prior(*a.G, *b.G);
  EXPECT_TRUE(prior.T_target_source.translation().isApprox(Eigen::Vector3d(0, -10, 0), 1e-3));
  EXPECT_NEAR(prior.sigma_yaw_rad, 0.2, 1e-9);
  EXPECT_NEAR(prior.sigma_translation_m, std::sqrt(4.0 + 4.0), 1e-3) << "10 m swung by 0.2 rad are 2 m";
  const auto same = registration_prior({kTarget, kSource}, a, b, {});
  ASSERT_TRUE(same);
  EXPECT_TRUE(same->T_target_source.matrix() == prior.T_target_source.matrix());
}

TEST(RegistrationPrior, PriorOfATransformIsWiderThanThatOfOdometry) {
  LoopCandidate candidate{kTarget, kSource, LoopCandidate::Origin::kTransform};
  candidate.T_target_source = UncertainPose{Pose::Identity(), 1e-4 * Matrix6d::Identity()};
  const graph::Node a = node_of_variance(kTarget, 0.0, 1.0), b = node_of_variance(kSource, 10.0, 1.0);
  const auto transform = registration_prior(candidate, a, b, {});
  candidate.origin = LoopCandidate::Origin::kOdometry;
  const auto odometry = registration_prior(candidate, a, b, {});
  ASSERT_TRUE(transform && odometry);
  EXPECT_EQ(transform->T_target_source.translation().norm(), 0.0) << "its own, and not that of G";
  EXPECT_NEAR(transform->sigma_translation_m, 1.51, 1e-9);
  EXPECT_NEAR(odometry->sigma_translation_m, 0.11, 1e-9);
}

TEST(RegistrationPrior, IsNoneWithoutGAndDescriptors) {
  graph::Node a = node_of_variance(kTarget, 0.0, 1.0), b = node_of_variance(kSource, 10.0, 1.0);
  b.G->covariance *= 1e6;
  EXPECT_FALSE(registration_prior({kTarget, kSource}, a, b, {}));
}

}  // namespace
}  // namespace fleetmap::loop_closure
