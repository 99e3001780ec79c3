// Faulty GPS fixes: wrong positions, wrong covariances, jumps.
#include <gtest/gtest.h>

#include <limits>

#include "localization/ekf_expectations.hpp"
#include "support/field_bounds.hpp"

namespace fleetmap::localization {
namespace {

using fleetmap::testing::kNaN;

using namespace testing;

TEST(EkfFixes, WrongHemisphereFixesAreRefused) {
  const Drive drive(70.0);
  Sensors sensors;
  sensors.spoil_fix = [](double t, sensor::Fix& fix) {
    if (t > 20.0 && t < 50.0) fix.position.latitude = -fix.position.latitude;
    if (t > 50.0 && t < 52.0) fix.position.longitude = -fix.position.longitude;
  };
  const Ekf ekf = run(sensors, drive, 60.0);
  EXPECT_GT(ekf.counters().fix_implausible, 150u);
  EXPECT_EQ(ekf.counters().fix_recoveries, 0u);
  expect_near_truth(ekf, drive);
}

TEST(EkfFixes, FirstFixInTheWrongHemisphereDoesNotLockOutTheRest) {
  const Drive drive(40.0);
  for (const double wrong_until : {0.05, 0.3}) {
    Sensors sensors;
    sensors.spoil_fix = [wrong_until](double t, sensor::Fix& fix) {
      if (t < wrong_until) fix.position.latitude = -fix.position.latitude;
    };
    const Ekf ekf = run(sensors, drive, 30.0);
    expect_near_truth(ekf, drive);
    EXPECT_EQ(ekf.counters().fix_implausible, 0u);
  }
}

TEST(EkfFixes, WrongStartIsLeftAfterAMinuteOfFixesThatAgree) {
  const Drive drive(130.0);
  Sensors sensors;
  sensors.spoil_fix = [](double t, sensor::Fix& fix) {
    if (t < 3.0) fix.position.latitude = -fix.position.latitude;
  };
  const Ekf ekf = run(sensors, drive, 120.0);
  EXPECT_EQ(ekf.counters().fix_recoveries, 1u);
  expect_near_truth(ekf, drive);
}

TEST(EkfFixes, ConfiguredSiteNeverFollowsFixesFarAway) {
  const Drive drive(130.0);
  Sensors sensors;
  sensors.spoil_fix = [](double t, sensor::Fix& fix) {
    if (t < 3.0 || t > 30.0) fix.position.latitude = -fix.position.latitude;
  };
  EkfConfig config;
  config.site_origin = kSite;
  const Ekf ekf = run(sensors, drive, 120.0, config);
  EXPECT_EQ(ekf.counters().fix_recoveries, 0u);
  ASSERT_TRUE(ekf.pose());
  EXPECT_LT(haversine_distance(ekf.pose()->position, kSite), 500.0);
  EXPECT_EQ(ekf.frame()->origin(), kSite);
}

TEST(EkfFixes, CovariancesThatSayNothingAreReplaced) {
  const Drive drive(70.0);
  const Eigen::Matrix3d bad[] = {Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Constant(kNaN<double>),
                                 Eigen::Matrix3d(-Eigen::Matrix3d::Identity()),
                                 Eigen::Matrix3d::Constant(std::numeric_limits<double>::infinity()),
                                 Eigen::Matrix3d(Eigen::Matrix3d::Identity() * 1e300)};
  for (const Eigen::Matrix3d& covariance : bad) {
    Sensors sensors;
    sensors.spoil_fix = [&](double, sensor::Fix& fix) { fix.covariance = covariance; };
    const Ekf ekf = run(sensors, drive, 60.0);
    EXPECT_EQ(ekf.counters().fix_covariance_replaced, 301u);
    expect_near_truth(ekf, drive);
  }
}

TEST(EkfFixes, HugeOrTinyOrIndefiniteCovariancesStayWithinFloorAndCeiling) {
  const Drive drive(30.0);
  Eigen::Matrix3d indefinite = Eigen::Matrix3d::Identity();
  indefinite(0, 1) = indefinite(1, 0) = 5.0;
  for (const Eigen::Matrix3d& covariance :
       {Eigen::Matrix3d(Eigen::Matrix3d::Identity() * 1e12),
        Eigen::Matrix3d(Eigen::Matrix3d::Identity() * 1e-30), indefinite}) {
    Sensors sensors;
    sensors.spoil_fix = [&](double, sensor::Fix& fix) { fix.covariance = covariance; };
    const Ekf ekf = run(sensors, drive, 20.0);
    ASSERT_TRUE(ekf.pose());
    expect_sound(*ekf.pose());
    EXPECT_LE(ekf.pose()->covariance(0, 0), 1.1e6);
    EXPECT_EQ(ekf.counters().fix_covariance_replaced, 0u);
  }
}

TEST(EkfFixes, InvalidFixesAreRefusedAndCounted) {
  const Drive drive(30.0);
  int n = 0;
  Sensors sensors;
  sensors.spoil_fix = [&n](double t, sensor::Fix& fix) {
    if (t <= 10.0) return;
    switch (n++ % 5) {
      case 0:
        fix.position.latitude = kNaN<double>;
        break;
      case 1:
        fix.position.altitude = std::numeric_limits<double>::infinity();
        break;
      case 2:
        fix.valid = false;
        break;
      case 3:
        fix.position = {0.0, 0.0, 0.0};
        break;
      default:
        fix.position.longitude = 8.4;
        break;  // degrees where radians belong
    }
  };
  const Ekf ekf = run(sensors, drive, 20.0);
  EXPECT_EQ(ekf.counters().fix_invalid, 50u);
  expect_near_truth(ekf, drive);
}

TEST(EkfFixes, JumpOfAFewSecondsIsGatedAndALongOneIsBelievedAtLast) {
  const Drive drive(130.0);
  Sensors sensors;
  sensors.spoil_fix = [](double t, sensor::Fix& fix) {
    if (t > 60.0 && t < 65.0) fix.position.latitude += 40.0 / kMeanEarthRadius;
  };
  const Ekf brief = run(sensors, drive, 70.0);
  EXPECT_GE(brief.counters().fix_gated + brief.counters().fix_implausible, 24u);
  EXPECT_EQ(brief.counters().fix_recoveries, 0u);
  expect_near_truth(brief, drive);

  sensors.spoil_fix = [](double t, sensor::Fix& fix) {
    if (t < 60.0) fix.position.latitude += 40.0 / kMeanEarthRadius;
  };
  const Ekf lasting = run(sensors, drive, 120.0);
  EXPECT_EQ(lasting.counters().fix_recoveries, 1u);
  expect_near_truth(lasting, drive);
}

}  // namespace
}  // namespace fleetmap::localization
