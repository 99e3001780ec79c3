#include "localization/ekf_expectations.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

namespace fleetmap::localization::testing {

void expect_sound(const GlobalPose& G) {
  EXPECT_TRUE(is_valid(G.position));
  EXPECT_TRUE(G.covariance.allFinite());
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix6d>(G.covariance).eigenvalues().minCoeff(), 0.0);
  EXPECT_NEAR(G.q_enu_base.norm(), 1.0, 1e-9);
}

Ekf run(const Sensors& sensors, const Drive& drive, double duration, const EkfConfig& config) {
  Ekf ekf(config);
  for (const Sample& sample : sensors.measure(drive, duration)) add(ekf, sample);
  return ekf;
}

void expect_near_truth(const Ekf& ekf, const Drive& drive, double sigmas) {
  const auto G = ekf.pose();
  ASSERT_TRUE(G);
  expect_sound(*G);
  const PoseError error = error_of(*G, drive.at(to_seconds(G->stamp - at_time(0))));
  EXPECT_LT(error.nees_horizontal, sigmas * sigmas) << "error " << error.horizontal() << " m";
  EXPECT_LT(error.horizontal(), 6.0);
}

}  // namespace fleetmap::localization::testing
