#include "fleetmap/registration/map_drift.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace fleetmap::registration {
namespace {

TEST(MapDrift, AStraightPathGoesThroughTheOriginToBothSides) {
  const MapDrift drift = MapDrift::straight(0.01, 0.001, 30.0);
  ASSERT_FALSE(drift.stops.empty());
  EXPECT_LE(drift.stops.front().T_cloud_base.translation().x(), -30.0);
  EXPECT_GE(drift.stops.back().T_cloud_base.translation().x(), 30.0);
  EXPECT_LT(drift.stops.back().T_cloud_base.translation().x(), 40.0);
  EXPECT_TRUE(drift.stops[drift.stops.size() / 2].T_cloud_base.isApprox(Pose::Identity()));
  EXPECT_TRUE(drift.validate());
}

/// The variance of a way is its length times the square of the sigma, however many steps it takes.
TEST(MapDrift, AStraightPathErrsByTheRootOfItsLength) {
  const MapDrift drift = MapDrift::straight(0.01, 0.001, 30.0);
  Matrix6d sum = Matrix6d::Zero();
  for (std::size_t k = 1; k < drift.stops.size(); ++k) sum += drift.stops[k].step_covariance;
  const double length =
      drift.stops.back().T_cloud_base.translation().x() - drift.stops.front().T_cloud_base.translation().x();
  Vector6d variances;
  variances << Eigen::Vector3d::Constant(length * 0.01 * 0.01),
      Eigen::Vector3d::Constant(length * 0.001 * 0.001);
  EXPECT_LT((sum - Matrix6d(variances.asDiagonal())).norm(), 1e-12);
}

TEST(MapDrift, SaysWhatIsWrongWithItsStops) {
  EXPECT_TRUE(MapDrift{}.validate()) << "without stops a straight path is assumed";
  MapDrift drift = MapDrift::straight();
  drift.stops[3].T_cloud_base.translation().x() = std::nan("");
  EXPECT_EQ(drift.validate().error().message, "map drift: poses of stops must be finite");
  for (const double wrong : {-1e-9, std::nan(""), std::numeric_limits<double>::infinity()}) {
    drift = MapDrift::straight();
    drift.stops[3].step_covariance(4, 4) = wrong;
    ASSERT_FALSE(drift.validate()) << wrong;
    EXPECT_EQ(drift.validate().error().message,
              "map drift: covariances of steps must be finite, their diagonals not negative");
  }
  drift = MapDrift::straight();
  drift.stops[3].step_covariance(0, 1) = -1e-6;
  EXPECT_TRUE(drift.validate()) << "off the diagonal any sign will do";
}

}  // namespace
}  // namespace fleetmap::registration
