#include "pose_uncertainty.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fleetmap::odometry {
namespace {

/// A scan that knows its pose to `pose_sigma` by its points, and its motion as well as `prior_sigma` says.
MatchResult match(double pose_sigma, double prior_sigma) {
  MatchResult result;
  result.lidar_information.diagonal().head<6>().setConstant(1.0 / (pose_sigma * pose_sigma));
  result.prior_information.diagonal().setConstant(1.0 / (prior_sigma * prior_sigma));
  return result;
}

/// As if the points had moved the translation by `d` m from where the prior had it.
MatchResult moved(MatchResult result, const Eigen::Vector3d& d) {
  result.prior_gradient.head<3>() = result.prior_information.topLeftCorner<3, 3>() * d;
  return result;
}

PoseUncertainty started() {
  PoseUncertainty uncertainty{LoamConfig{}};
  uncertainty.start();
  return uncertainty;
}

Vector6d noise_of(PoseUncertainty& uncertainty, const PoseUncertainty::Matched& scan) {
  return uncertainty.state(scan).pose_noise.diagonal();
}

TEST(PoseUncertainty, AtTheStartThePoseIsGivenAndTheVelocityUnknown) {
  const LoamConfig config;
  const PoseUncertainty uncertainty = started();
  EXPECT_EQ(uncertainty.covariance().diagonal().head<6>().norm(), 0.0);
  EXPECT_DOUBLE_EQ(uncertainty.covariance()(7, 7), config.initial_speed * config.initial_speed);
  EXPECT_DOUBLE_EQ(uncertainty.covariance()(11, 11), config.initial_turn_rate * config.initial_turn_rate);
}

TEST(PoseUncertainty, PointsTellThePoseAsWellAsTheyFitTheirSurfaces) {
  PoseUncertainty uncertainty = started();
  MatchResult scan = match(0.01, 1.0);
  EXPECT_NEAR(noise_of(uncertainty, {scan})[0], 1e-4, 1e-7);
  scan.residual_variance = 4.0;
  EXPECT_NEAR(noise_of(uncertainty, {scan})[0], 4e-4, 1e-6);
}

TEST(PoseUncertainty, LostScanHasThePriorsUncertainty) {
  PoseUncertainty uncertainty = started();
  const MatchResult scan = match(0.01, 0.5);
  EXPECT_NEAR(noise_of(uncertainty, {.match = scan, .lost = true})[2], 0.25, 1e-12);
}

/// d_stamp = d_pose + s d_twist.
TEST(PoseUncertainty, BetweenStampAndReferenceTheVelocityCounts) {
  PoseUncertainty uncertainty = started();
  const MatchResult scan = match(0.01, 0.2);
  const double at_reference = noise_of(uncertainty, {scan})[1];
  const double at_stamp = noise_of(uncertainty, {.match = scan, .reference_offset = 0.1})[1];
  const double of_twist = 0.04 * 10.0 / (10.0 + 6.0);  // the prior was met exactly, in six dimensions
  EXPECT_NEAR(at_stamp - at_reference, 0.01 * of_twist, 5e-6);
}

TEST(PoseUncertainty, ATurnThatChangesWithinTheSweepBendsIt) {
  PoseUncertainty uncertainty = started();
  const MatchResult scan = match(0.001, 1.0);
  PoseUncertainty::Matched swept{.match = scan, .half_sweep = 0.06};
  swept.turn_acceleration_variance = Eigen::Vector3d(0.0, 0.0, 4.0);
  const double steady = noise_of(uncertainty, {scan})[5];
  EXPECT_NEAR(noise_of(uncertainty, swept)[5] - steady, 4.0 * std::pow(0.06 * 0.06 / 6.0, 2), 1e-12);
  EXPECT_NEAR(noise_of(uncertainty, swept)[4] - steady, 0.0, 1e-12);
}

TEST(PoseUncertainty, WithoutAGyroATurnMayChangeAsMuchAsItHas) {
  PoseUncertainty uncertainty = started();
  const MatchResult scan = match(0.001, 1.0);
  const PoseUncertainty::Matched swept{.match = scan, .half_sweep = 0.06};
  const double before = noise_of(uncertainty, swept)[5];
  for (int k = 0; k < 100; ++k) uncertainty.turn_changed({0.0, 0.0, 2.0});
  EXPECT_NEAR(noise_of(uncertainty, swept)[5] - before, 4.0 * std::pow(0.06 * 0.06 / 6.0, 2), 1e-10);
}

/// Points and prior know the translation equally well; where points keep moving it by more than both say, the
/// prior is worse than it says, and where they never move it, better. With a gyro its rotation is not rated.
TEST(PoseUncertainty, APriorIsRatedByHowFarPointsMoveIt) {
  const MatchResult scan = match(0.1, 0.1);
  PoseUncertainty shaken = started(), smooth = started();
  const double as_stated = noise_of(shaken, {scan})[0];
  for (int k = 0; k < 200; ++k) {
    const double side = k % 2 == 0 ? 1.0 : -1.0;
    shaken.state({moved(scan, side * Eigen::Vector3d(0.3, 0.3, 0.3))});
    smooth.state({scan});
  }
  EXPECT_GT(noise_of(shaken, {moved(scan, {0.3, 0.3, 0.3})})[0], 2.0 * as_stated);
  EXPECT_LT(noise_of(smooth, {scan})[0], 0.8 * as_stated);
  EXPECT_LT(noise_of(smooth, {scan})[4], 0.8 * as_stated) << "nor did they ever turn it";
  const PoseUncertainty::Matched with_gyro{.match = scan,
                                           .turn_acceleration_variance = Eigen::Vector3d::Zero()};
  EXPECT_NEAR(noise_of(smooth, with_gyro)[4], 0.5 * 0.1 * 0.1, 1e-12);
}

TEST(PoseUncertainty, TheNextPriorTakesTheLastPoseAsItWasKnown) {
  const LoamConfig config;
  PoseUncertainty uncertainty = started();
  MatchResult scan = match(0.01, 1.0);
  scan.prior_information.diagonal().tail<6>().setConstant(1e-6);  // the velocity is as good as unknown
  uncertainty.state({scan});
  const Matrix12d& covariance = uncertainty.covariance();
  EXPECT_NEAR(covariance(0, 0), 1e-4, 1e-7);
  EXPECT_NEAR(covariance(6, 6), config.initial_speed * config.initial_speed, 1e-9) << "never less known";
  EXPECT_EQ(covariance, covariance.transpose());

  uncertainty.map_restarted();
  EXPECT_EQ(uncertainty.covariance().topRows<6>().norm(), 0.0);
  EXPECT_EQ(uncertainty.covariance().leftCols<6>().norm(), 0.0);
  EXPECT_GT(uncertainty.covariance()(6, 6), 0.0);
}

TEST(PoseUncertainty, TheMapDriftsWithTheWay) {
  const LoamConfig config;
  const MatchResult scan = match(0.01, 1.0);
  PoseUncertainty standing = started(), driving = started();
  EXPECT_EQ(standing.state({scan}).growth.norm(), 0.0);
  PoseUncertainty::Matched metre{scan};
  metre.T_before_now.translation().x() = 1.0;
  const auto [noise, growth] = driving.state(metre);
  EXPECT_NEAR(growth(0, 0),
              config.drift_share * noise(0, 0) + config.drift_translation * config.drift_translation, 1e-12);
  EXPECT_NEAR(growth(5, 5), config.drift_share * noise(5, 5) + config.drift_rotation * config.drift_rotation,
              1e-12);
}

/// The map is made of poses at reference instants; what is not known of the way from there to the stamp does
/// not enter it.
TEST(PoseUncertainty, TheMapDriftsAsItsOwnPosesErr) {
  const MatchResult scan = match(0.01, 1.0);
  PoseUncertainty at_stamp = started(), before = started();
  PoseUncertainty::Matched metre{scan};
  metre.T_before_now.translation().x() = 1.0;
  const auto near = at_stamp.state(metre);
  metre.reference_offset = 0.5;
  const auto far = before.state(metre);
  EXPECT_GT(far.pose_noise(0, 0), 1.2 * near.pose_noise(0, 0));
  EXPECT_TRUE(far.growth.isApprox(near.growth));
}

/// A scan that sees nothing of where along x it is, a fifth of a metre on.
MatchResult aisle() {
  MatchResult scan = match(0.01, 0.3);
  scan.lidar_information(0, 0) = 0.0;
  scan.degenerate_count = 1;
  scan.degenerate_directions(0, 0) = 1.0;
  return scan;
}
PoseUncertainty::Matched a_fifth_on(const MatchResult& scan) {
  PoseUncertainty::Matched step{scan};
  step.T_before_now.translation().x() = 0.2;
  return step;
}

/// If the scene does not constrain the motion, the error stays once in the map that is built meanwhile.
TEST(PoseUncertainty, AlongAnAisleTheErrorStays) {
  PoseUncertainty uncertainty = started();
  MatchResult scan = aisle();
  scan.speed_measured = true;  // else map and scans may slide together, see below
  double sum = 0.0, noise = 0.0, sideways = 0.0;
  for (int k = 0; k < 100; ++k) {
    const auto stated = uncertainty.state(a_fifth_on(scan));
    sum += stated.growth(0, 0);
    sideways += stated.growth(1, 1);
    noise = stated.pose_noise(0, 0);
  }
  EXPECT_GE(sum, noise);
  EXPECT_LT(sum, 3.0 * noise) << "the prior turned out to be better than it said";
  EXPECT_LT(sideways, 0.1 * noise);
}

/// One such scan among others is soon a small part of the map: the others take back what it did not see.
TEST(PoseUncertainty, AScanThatTheMapHoldsAgainTakesTheErrorBack) {
  PoseUncertainty uncertainty = started();
  const MatchResult held = match(0.01, 0.3), unheld = aisle();
  uncertainty.state({held});
  const auto lone = uncertainty.state(a_fifth_on(unheld));
  EXPECT_GT(std::sqrt(lone.pose_noise(0, 0)), 0.2);
  EXPECT_LT(std::sqrt(lone.growth(0, 0)), 0.05);
  EXPECT_LT(std::sqrt(uncertainty.state(a_fifth_on(held)).pose_noise(0, 0)), 0.011);
}

/// Directions are of [m, rad x range]: a metre that is unknown is not a radian.
TEST(PoseUncertainty, DegenerateRotationIsStatedInRadians) {
  PoseUncertainty uncertainty = started();
  MatchResult scan = match(0.01, 1.0);
  scan.range = 10.0;
  scan.degenerate_count = 1;
  scan.degenerate_directions.col(0) << 0, std::sqrt(0.5), 0, 0, 0, std::sqrt(0.5);
  Matrix6d information = Matrix6d::Zero();  // 1 cm across that direction, nothing along it
  const Vector6d blind = (Vector6d() << 0, 1, 0, 0, 0, 0.1).finished().normalized();
  information = 1e4 * (Matrix6d::Identity() - blind * blind.transpose());
  scan.lidar_information.topLeftCorner<6, 6>() = information;
  Matrix6d sum = Matrix6d::Zero();
  for (int k = 0; k < 60; ++k) sum += uncertainty.state(a_fifth_on(scan)).growth;
  EXPECT_NEAR(std::sqrt(sum(5, 5) / sum(1, 1)), 0.1, 0.02);
}

/// A map that was laid by scans which it did not hold agrees with the next one, wherever both have slid to.
TEST(PoseUncertainty, WithoutWheelsAMapOfUnheldScansIsNoWitness) {
  const auto stated_after_20_m = [](bool wheels) {
    PoseUncertainty uncertainty = started();
    MatchResult held = match(0.01, 0.3), unheld = aisle();
    held.speed_measured = unheld.speed_measured = wheels;
    double sum = 0.0;
    for (int k = 0; k < 100; ++k)
      sum += uncertainty.state(a_fifth_on(k % 5 == 4 ? held : unheld)).growth(0, 0);
    return std::sqrt(sum);
  };
  EXPECT_GT(stated_after_20_m(false), 3.0);
  EXPECT_LT(stated_after_20_m(true), 1.0);
}

/// In such a map a direction that seems to be held, but by little, may have slid as well. Elsewhere it is
/// right.
TEST(PoseUncertainty, WhereScansSlideWeakDirectionsAreStatedToo) {
  const auto sideways_after_20_m = [](int unheld_of_five) {
    PoseUncertainty uncertainty = started();
    MatchResult held = match(0.01, 0.3), unheld = aisle();
    unheld.degenerate_directions.col(1) = held.degenerate_directions.col(0) = Vector6d::Unit(1);
    unheld.weak_count = held.weak_count = 1;
    double sum = 0.0;
    for (int k = 0; k < 100; ++k)
      sum += uncertainty.state(a_fifth_on(k % 5 < unheld_of_five ? unheld : held)).growth(1, 1);
    return std::sqrt(sum);
  };
  EXPECT_GT(sideways_after_20_m(4), 3.0);
  EXPECT_LT(sideways_after_20_m(0), 0.1);
}

/// A warped map holds its scans well, but by little, and no robot moves as they say.
TEST(PoseUncertainty, WeakScansOfAStrangeMotionMaySlide) {
  const auto sideways_after_20_m = [](double strange) {
    PoseUncertainty uncertainty = started();
    MatchResult held = match(0.01, 0.3);
    held.degenerate_directions.col(0) = Vector6d::Unit(1);
    held.weak_count = 1;
    held = moved(held, strange * Eigen::Vector3d(1.0, 1.0, 0.0));
    double sum = 0.0;
    for (int k = 0; k < 100; ++k) sum += uncertainty.state(a_fifth_on(held)).growth(1, 1);
    return std::sqrt(sum);
  };
  EXPECT_GT(sideways_after_20_m(1.0), 3.0);
  EXPECT_LT(sideways_after_20_m(0.1), 0.1);
}

TEST(PoseUncertainty, UnsolvableScansAreNotUsedForTheVariance) {
  PoseUncertainty uncertainty = started(), untouched = started();
  MatchResult broken = match(0.1, 0.1);
  broken.prior_gradient.setConstant(std::nan(""));
  for (int k = 0; k < 50; ++k) uncertainty.state({broken});
  const MatchResult scan = match(0.1, 0.1);
  EXPECT_EQ(noise_of(uncertainty, {scan}), noise_of(untouched, {scan}));
}

TEST(PriorMisfit, IsNearOneUntilMuchIsKnown) {
  PriorMisfit misfit;
  EXPECT_EQ(misfit.variance(), 1.0);
  misfit.add(12.0, 3.0);
  EXPECT_NEAR(misfit.variance(), 22.0 / 13.0, 1e-12);
  for (int k = 0; k < 500; ++k) misfit.add(12.0, 3.0);
  EXPECT_NEAR(misfit.variance(), 250.0 / 70.0, 1e-6);
}

}  // namespace
}  // namespace fleetmap::odometry
