#include "fleetmap/sim/gps.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/stamps.hpp"

namespace fleetmap::sim {
namespace {

const LocalFrame kSite(geo_point_from_degrees(49.0, 8.4, 110.0));

GpsSpec perfect_gps() {
  GpsSpec spec;
  spec.white_sigma = spec.drift_sigma = 0.0;
  return spec;
}

/// Errors of `fixes` fixes, m.
std::vector<Eigen::Vector3d> errors(const GpsSpec& spec, std::uint64_t seed, int fixes,
                                    const Eigen::Vector3d& p = {3.0, -20.0, 1.0}) {
  GpsModel gps(spec, kSite, seed);
  std::vector<Eigen::Vector3d> all;
  for (int k = 1; k <= fixes; ++k) {
    const double t = k / spec.rate;
    all.push_back(kSite.to_enu(gps.measure(at(t), t, p).value().position) - p);
  }
  return all;
}

TEST(GpsModel, APerfectReceiverIsWhereItsAntennaIs) {
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(150, -70, 12)}) {
    for (const Eigen::Vector3d& error : errors(perfect_gps(), 1, 5, p)) EXPECT_LT(error.norm(), 1e-6);
  }
  GpsModel gps(perfect_gps(), kSite, 1);
  const auto fix = gps.measure(at(7.5), 7.5, {0, 0, 0});
  ASSERT_TRUE(fix);
  EXPECT_EQ(fix->stamp, at(7.5));
  EXPECT_EQ(fix->covariance, Eigen::Matrix3d::Zero());
}

TEST(GpsModel, TheReportedCovarianceIsThatOfWhiteNoiseAndDrift) {
  GpsSpec spec;
  spec.white_sigma = 0.3;
  spec.drift_sigma = 0.4;
  spec.vertical_factor = 3.0;
  spec.covariance_factor = 2.0;
  spec.jumps_per_hour = 3600.0;  // never reported
  GpsModel gps(spec, kSite, 1);
  const Eigen::Matrix3d C = gps.measure(at(0.2), 0.2, {0, 0, 0})->covariance;
  EXPECT_TRUE(C.isApprox(Eigen::Vector3d(0.5, 0.5, 4.5).asDiagonal().toDenseMatrix(), 1e-12)) << C;
}

TEST(GpsModel, WhiteErrorsHaveTheirSigmaAndNoMemory) {
  GpsSpec spec = perfect_gps();
  spec.white_sigma = 0.5;
  spec.vertical_factor = 3.0;
  constexpr int kFixes = 20'000;
  const auto all = errors(spec, 2, kFixes);
  Eigen::Vector3d squares = Eigen::Vector3d::Zero(), products = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k + 1 < all.size(); ++k) {
    squares += all[k].cwiseAbs2() / kFixes;
    products += all[k].cwiseProduct(all[k + 1]) / kFixes;
  }
  EXPECT_NEAR(squares.x(), 0.25, 0.01);
  EXPECT_NEAR(squares.y(), 0.25, 0.01);
  EXPECT_NEAR(squares.z(), 2.25, 0.09);
  EXPECT_LT(products.cwiseQuotient(squares).cwiseAbs().maxCoeff(), 0.03);
}

TEST(GpsModel, OneErrorDoesNotChangeTheLuckOfAnother) {
  GpsSpec white = perfect_gps(), drift = perfect_gps(), wave = perfect_gps(), jumps = perfect_gps(), all;
  white.white_sigma = all.white_sigma = 0.3;
  drift.drift_sigma = all.drift_sigma = 1.0;
  wave.altitude_wave = all.altitude_wave = 2.0;
  jumps.jumps_per_hour = all.jumps_per_hour = 600.0;
  const auto a = errors(white, 5, 200), b = errors(drift, 5, 200), c = errors(wave, 5, 200),
             d = errors(jumps, 5, 200), sum = errors(all, 5, 200);
  double jumped = 0.0;
  for (std::size_t k = 0; k < sum.size(); ++k) {
    EXPECT_LT((a[k] + b[k] + c[k] + d[k] - sum[k]).norm(), 1e-5) << k;
    jumped = std::max(jumped, d[k].norm());
  }
  EXPECT_NEAR(jumped, 8.0, 1e-5);
}

TEST(GpsModel, SameSeedSameErrorsWhereverTheRobotIs) {
  const GpsSpec spec;
  const auto here = errors(spec, 3, 50), there = errors(spec, 3, 50, {-50, 60, 5}),
             other = errors(spec, 4, 50);
  for (std::size_t k = 0; k < 50; ++k) {
    EXPECT_LT((here[k] - there[k]).norm(), 1e-5);
    EXPECT_GT((here[k] - other[k]).norm(), 1e-3);
  }
}

TEST(GpsModel, GoesOnWhereItWasMoved) {
  GpsModel first(GpsSpec{}, kSite, 3), copy(GpsSpec{}, kSite, 3);
  for (int k = 1; k < 5; ++k) EXPECT_TRUE(first.measure(at(0.2 * k), 0.2 * k, {0, 0, 0}));
  for (int k = 1; k < 5; ++k) EXPECT_TRUE(copy.measure(at(0.2 * k), 0.2 * k, {0, 0, 0}));
  GpsModel moved = std::move(first);
  EXPECT_EQ(moved.measure(at(1.0), 1.0, {0, 0, 0})->position.latitude,
            copy.measure(at(1.0), 1.0, {0, 0, 0})->position.latitude);
}

}  // namespace
}  // namespace fleetmap::sim
