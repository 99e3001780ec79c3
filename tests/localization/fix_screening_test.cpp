#include "fix_screening.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <limits>

#include "support/field_bounds.hpp"

namespace fleetmap::localization {
namespace {

using fleetmap::testing::kNaN;

const GeoPoint kOrigin = geo_point_from_degrees(48.0, 11.0, 500.0);

sensor::Fix plain_fix(const Eigen::Vector3d& p_enu, double seconds = 0.0) {
  sensor::Fix fix;
  fix.stamp = stamp_from_ns(static_cast<std::int64_t>(seconds * 1e9));
  fix.position = LocalFrame(kOrigin).to_geo(p_enu);
  return fix;
}

TEST(FixScreening, APlausibleCovarianceIsKept) {
  Eigen::Matrix3d C;
  C << 4.0, 1.0, 0.0, 1.0, 3.0, 0.5, 0.0, 0.5, 9.0;
  const BoundedCovariance bounded = bounded_covariance(C, {});
  EXPECT_FALSE(bounded.replaced);
  EXPECT_TRUE(bounded.R.isApprox(C, 1e-9));
}

TEST(FixScreening, EigenvaluesAreClampedToFloorAndCeiling) {
  const GpsModel model;
  const Eigen::Vector3d sigmas(1e-6, 1.0, 1e6);
  const BoundedCovariance bounded = bounded_covariance(sigmas.cwiseAbs2().asDiagonal(), model);
  EXPECT_FALSE(bounded.replaced);
  EXPECT_NEAR(std::sqrt(bounded.R(0, 0)), model.sigma_floor, 1e-9);
  EXPECT_NEAR(std::sqrt(bounded.R(1, 1)), 1.0, 1e-9);
  EXPECT_NEAR(std::sqrt(bounded.R(2, 2)), model.sigma_ceiling, 1e-6);
  // Positive on the diagonal, but indefinite: its negative eigenvalue becomes the floor.
  Eigen::Matrix3d indefinite = Eigen::Matrix3d::Identity();
  indefinite(0, 1) = indefinite(1, 0) = 5.0;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(bounded_covariance(indefinite, model).R);
  EXPECT_NEAR(std::sqrt(eigen.eigenvalues()(0)), model.sigma_floor, 1e-6);
}

TEST(FixScreening, AnUnusableCovarianceIsReplacedByTheDefault) {
  const GpsModel model;
  Eigen::Matrix3d with_nan = Eigen::Matrix3d::Identity();
  with_nan(0, 2) = kNaN<double>;
  Eigen::Matrix3d negative = Eigen::Matrix3d::Identity();
  negative(2, 2) = -1.0;
  for (const Eigen::Matrix3d& C :
       {Eigen::Matrix3d(Eigen::Matrix3d::Zero()), with_nan, negative,
        Eigen::Matrix3d(1e200 * Eigen::Matrix3d::Identity()),
        Eigen::Matrix3d(std::numeric_limits<double>::infinity() * Eigen::Matrix3d::Ones())}) {
    const BoundedCovariance bounded = bounded_covariance(C, model);
    EXPECT_TRUE(bounded.replaced);
    EXPECT_DOUBLE_EQ(bounded.R(0, 0), model.default_sigma_h * model.default_sigma_h);
    EXPECT_DOUBLE_EQ(bounded.R(2, 2), model.default_sigma_v * model.default_sigma_v);
    EXPECT_EQ(bounded.R(0, 1), 0.0);
  }
}

TEST(FixScreening, OnlyFixesOnEarthAreUsable) {
  EXPECT_TRUE(is_usable(plain_fix({0, 0, 0})));
  sensor::Fix none = plain_fix({0, 0, 0});
  none.valid = false;
  EXPECT_FALSE(is_usable(none));
  for (const GeoPoint& wrong :
       {GeoPoint{0.0, 0.0, 100.0}, GeoPoint{kNaN<double>, 0.2, 0.0}, GeoPoint{0.8, 0.2, kNaN<double>},
        GeoPoint{2.0, 0.2, 0.0}, GeoPoint{0.8, 0.2, 20'001.0}}) {
    sensor::Fix fix;
    fix.position = wrong;
    EXPECT_FALSE(is_usable(fix)) << wrong.latitude << " " << wrong.longitude << " " << wrong.altitude;
  }
  sensor::Fix equator;
  equator.position = {0.0, 0.2, 0.0};
  EXPECT_TRUE(is_usable(equator));
}

TEST(FixScreening, ReachGrowsWithTimeAndUncertainty) {
  const GpsModel model;  // 40 m/s
  const GeoPoint there = plain_fix({100.0, 0.0, 0.0}).position;
  EXPECT_FALSE(is_reachable(kOrigin, there, 1.0, 1.0, model));  // 40 + 6 + 10
  EXPECT_TRUE(is_reachable(kOrigin, there, 2.5, 1.0, model));
  EXPECT_TRUE(is_reachable(kOrigin, there, 0.0, 16.0, model));
  EXPECT_FALSE(is_reachable(kOrigin, there, kNaN<double>, 1.0, model));
  const GeoPoint above = plain_fix({0.0, 0.0, 100.0}).position;
  EXPECT_FALSE(is_reachable(kOrigin, above, 0.0, 1.0, model));
  EXPECT_TRUE(is_reachable(kOrigin, above, 0.0, 10.0, model));  // altitude errs four sigmas more
}

TEST(FixScreening, ARunCountsFixesThatAgreeAndStartsAgainAtOneThatDoesNot) {
  const GpsModel model;
  FixRun run;
  extend_run(run, plain_fix({0, 0, 0}, 10.0), 1.0, model);
  extend_run(run, plain_fix({5, 0, 0}, 11.0), 2.0, model);
  extend_run(run, plain_fix({9, 0, 0}, 12.0), 1.0, model);
  EXPECT_EQ(run.count, 3);
  EXPECT_EQ(run.first, plain_fix({}, 10.0).stamp);
  EXPECT_EQ(run.last, plain_fix({}, 12.0).stamp);
  extend_run(run, plain_fix({900, 0, 0}, 13.0), 1.0, model);
  EXPECT_EQ(run.count, 1);
  EXPECT_EQ(run.first, plain_fix({}, 13.0).stamp);
  EXPECT_EQ(run.position, plain_fix({900, 0, 0}).position);
}

}  // namespace
}  // namespace fleetmap::localization
