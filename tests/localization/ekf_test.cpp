#include "fleetmap/localization/ekf.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "localization/ekf_expectations.hpp"
#include "support/field_bounds.hpp"

namespace fleetmap::localization {
namespace {

using fleetmap::testing::kNaN;

using namespace testing;

TEST(Ekf, NoPoseBeforeTheFirstFixesAgree) {
  const Drive drive(3.0);
  Sensors sensors;
  sensors.gps = false;
  Ekf ekf = run(sensors, drive, 2.0);
  EXPECT_FALSE(ekf.pose());
  EXPECT_FALSE(ekf.pose_at(at_time(1.0)));
  EXPECT_FALSE(ekf.frame());
  EXPECT_EQ(ekf.counters().imu_used, 201u);
}

TEST(Ekf, HeadingIsUnknownUntilTheRobotHasMovedAndThenConverges) {
  const Drive drive(60.0, -2.3);
  Ekf ekf{EkfConfig{}};
  bool was_unknown = false;
  for (const Sample& sample : Sensors{}.measure(drive, 60.0)) {
    add(ekf, sample);
    if (const auto G = ekf.pose(); G && !ekf.heading_known()) {
      was_unknown = true;
      EXPECT_GT(G->covariance(5, 5), 3.0);
      expect_near_truth(ekf, drive, 5.0);
    }
  }
  EXPECT_TRUE(was_unknown);
  ASSERT_TRUE(ekf.heading_known());
  EXPECT_EQ(ekf.counters().heading_alignments, 1u);
  const PoseError error = error_of(*ekf.pose(), drive.at(60.0));
  EXPECT_LT(std::abs(error.rotation.z()), 0.12);
  EXPECT_LT(std::abs(error.rotation.z()), 4.0 * std::sqrt(ekf.pose()->covariance(5, 5)));
  EXPECT_LT(error.rotation.head<2>().norm(), 0.05);
}

TEST(Ekf, StandingRobotNeverClaimsAHeadingAndStaysLevel) {
  const Drive drive(
      300.0, 1.0, [](double) { return 0.0; }, [](double) { return 0.0; });
  const Ekf ekf = run({}, drive, 300.0);
  EXPECT_FALSE(ekf.heading_known());
  expect_near_truth(ekf, drive);
  EXPECT_LT(error_of(*ekf.pose(), drive.at(300.0)).nees, 30.0);
  EXPECT_GT(ekf.pose()->covariance(5, 5), 3.0);
}

TEST(Ekf, ReportedOrientationGivesTheHeadingAtOnce) {
  const Drive drive(5.0, 2.0);
  Sensors sensors;
  sensors.imu_orientation = true;
  const Ekf ekf = run(sensors, drive, 1.0);
  ASSERT_TRUE(ekf.heading_known());
  const double sigma = std::sqrt(ekf.pose()->covariance(5, 5));
  EXPECT_LT(sigma, 0.25);
  EXPECT_LT(std::abs(error_of(*ekf.pose(), drive.at(1.0)).rotation.z()), 2.5 * sigma);
  EXPECT_EQ(ekf.counters().heading_alignments, 0u);
}

TEST(Ekf, OrientationThatContradictsGravityIsIgnored) {
  const Drive drive(5.0);
  Sensors sensors;
  sensors.imu_orientation = true;
  Ekf ekf{EkfConfig{}};
  for (Sample sample : sensors.measure(drive, 1.0)) {
    if (auto* imu = std::get_if<sensor::Imu>(&sample)) {
      imu->q_enu_imu = Eigen::Quaterniond(rotation_from_rpy(std::numbers::pi, 0, 0)) * *imu->q_enu_imu;
    }
    add(ekf, sample);
  }
  EXPECT_FALSE(ekf.heading_known());
  EXPECT_GT(ekf.counters().orientations_inconsistent, 0u);
}

TEST(Ekf, WrongReportedHeadingIsMendedByMotion) {
  const Drive drive(120.0);
  for (const double wrong : {0.8, 1.6, 3.1, -2.0}) {
    Sensors sensors;
    sensors.imu_orientation = true;
    sensors.imu_yaw_error = wrong;
    const Ekf ekf = run(sensors, drive, 120.0);
    ASSERT_TRUE(ekf.heading_known());
    EXPECT_LT(std::abs(error_of(*ekf.pose(), drive.at(120.0)).rotation.z()), 0.2) << wrong;
  }
}

TEST(Ekf, GpsAloneGivesPositionsAndNoHeading) {
  const Drive drive(30.0);
  Sensors sensors;
  sensors.imu = sensors.wheel = false;
  const Ekf ekf = run(sensors, drive, 30.0);
  EXPECT_FALSE(ekf.heading_known());
  expect_near_truth(ekf, drive);
}

TEST(Ekf, BadImuAndWheelValuesAreRefused) {
  Ekf ekf{EkfConfig{}};
  sensor::Imu imu{at_time(1.0), {0, 0, kNaN<double>}, {0, 0, 9.8}, {}, {}};
  EXPECT_FALSE(ekf.add(imu));
  imu.angular_velocity.setZero();
  imu.specific_force.x() = 1e30;
  EXPECT_FALSE(ekf.add(imu));
  EXPECT_FALSE(ekf.add(sensor::Wheel{at_time(1.0), kNaN<double>, {}}));
  EXPECT_FALSE(ekf.add(sensor::Wheel{at_time(1.0), 1.0, kNaN<double>}));
  EXPECT_EQ(ekf.counters().imu_bad_value, 2u);
  EXPECT_EQ(ekf.counters().wheel_bad_value, 2u);
  EXPECT_FALSE(ekf.pose());
}

TEST(Ekf, TimeThatRepeatsOrRunsBackwardsIsRefusedAndChangesNothing) {
  const Drive drive(30.0);
  const auto samples = Sensors{}.measure(drive, 20.0);
  Ekf plain{EkfConfig{}};
  Ekf disturbed{EkfConfig{}};
  std::uint64_t refused = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    add(plain, samples[i]);
    add(disturbed, samples[i]);
    refused += add(disturbed, samples[i]) ? 0 : 1;      // again
    refused += add(disturbed, samples[i / 2]) ? 0 : 1;  // long ago
  }
  EXPECT_EQ(refused, 2 * samples.size());
  const EkfCounters counters = disturbed.counters();
  EXPECT_EQ(counters.imu_bad_time + counters.wheel_bad_time + counters.fix_bad_time, refused);
  EXPECT_EQ(plain.pose()->position, disturbed.pose()->position);
  EXPECT_EQ(plain.pose()->covariance, disturbed.pose()->covariance);
}

TEST(Ekf, OneStampFromTheFutureDoesNotStopTheClock) {
  const Drive drive(30.0);
  Ekf ekf{EkfConfig{}};
  bool sent = false;
  for (const Sample& sample : Sensors{}.measure(drive, 20.0)) {
    if (!sent && stamp_of(sample) > at_time(10.0)) {
      sent = true;
      EXPECT_FALSE(ekf.add(sensor::Wheel{at_time(1e9), 1.0, {}}));
      EXPECT_FALSE(ekf.add(sensor::Wheel{Stamp::max(), 1.0, {}}));
      EXPECT_FALSE(ekf.add(sensor::Wheel{Stamp::min(), 1.0, {}}));
    }
    EXPECT_TRUE(add(ekf, sample));
  }
  expect_near_truth(ekf, drive);
}

TEST(Ekf, ClockThatStepsBackForGoodStartsAnew) {
  const Drive drive(40.0);
  const auto samples = Sensors{}.measure(drive, 30.0);
  Ekf ekf{EkfConfig{}};
  for (int pass = 0; pass < 2; ++pass) {
    for (const Sample& sample : samples) add(ekf, sample);
  }
  EXPECT_EQ(ekf.counters().restarts, 1u);
  expect_near_truth(ekf, drive);
}

TEST(Ekf, OrderOfArrivalBetweenSensorsDoesNotMatter) {
  const Drive drive(30.0);
  const auto samples = Sensors{}.measure(drive, 20.0);
  Ekf in_order{EkfConfig{}};
  for (const Sample& sample : samples) add(in_order, sample);
  // Fixes arrive 0.2 s late and wheels 0.05 s.
  std::vector<std::pair<Stamp, Sample>> arrivals;
  for (const Sample& sample : samples) {
    const double delay = sample.index() == 2 ? 0.2 : sample.index() == 1 ? 0.05 : 0.0;
    arrivals.emplace_back(stamp_of(sample) + from_seconds(delay), sample);
  }
  std::stable_sort(arrivals.begin(), arrivals.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  Ekf late{EkfConfig{}};
  for (const auto& [arrival, sample] : arrivals) EXPECT_TRUE(add(late, sample));
  EXPECT_EQ(in_order.pose()->position, late.pose()->position);
  EXPECT_EQ(in_order.pose()->covariance, late.pose()->covariance);
  EXPECT_EQ(in_order.counters().fix_used, late.counters().fix_used);
}

TEST(Ekf, ImuGapIsBridgedWithGreaterUncertainty) {
  const Drive drive(70.0);
  Ekf ekf{EkfConfig{}};
  double before = 0.0;
  for (const Sample& sample : Sensors{}.measure(drive, 60.0)) {
    const double t = to_seconds(stamp_of(sample) - at_time(0));
    if (std::holds_alternative<sensor::Imu>(sample) && t > 40.0 && t < 44.0) continue;
    add(ekf, sample);
    if (t < 40.0) before = ekf.pose() ? ekf.pose()->covariance(3, 3) : 0.0;
    if (t > 43.9 && t < 44.0) {
      EXPECT_GT(ekf.pose()->covariance(3, 3), before);
    }
  }
  EXPECT_EQ(ekf.counters().imu_gaps, 1u);
  expect_near_truth(ekf, drive);
}

TEST(Ekf, PoseAtInterpolatesAndLooksALittleAhead) {
  const Drive drive(40.0);
  Sensors sensors;
  sensors.gps_sigma = 0.02;
  sensors.imu_rate = 10.0;
  sensors.wheel_rate = 10.0;
  EkfConfig config;
  config.history = 2.0;
  config.gps.correlation_time = 0.0;
  const Ekf ekf = run(sensors, drive, 30.0, config);
  for (const double t : {28.3, 28.333, 29.05, 29.999, 30.0, 30.08, 30.25}) {
    const auto G = ekf.pose_at(at_time(t));
    ASSERT_TRUE(G) << t;
    EXPECT_EQ(G->stamp, at_time(t));
    expect_sound(*G);
    EXPECT_LT(error_of(*G, drive.at(t)).horizontal(), 0.12) << t;
  }
  EXPECT_FALSE(ekf.pose_at(at_time(25.0)));
  EXPECT_FALSE(ekf.pose_at(at_time(30.4)));
  EXPECT_EQ(ekf.pose_at(at_time(30.0))->position, ekf.pose()->position);
}

TEST(Ekf, SlippingWheelsWeighLess) {
  const Drive drive(70.0);
  Ekf ekf{EkfConfig{}};
  for (Sample sample : Sensors{}.measure(drive, 60.0)) {
    const double t = to_seconds(stamp_of(sample) - at_time(0));
    if (auto* wheel = std::get_if<sensor::Wheel>(&sample); wheel != nullptr && t > 40.0 && t < 42.0) {
      wheel->forward_speed += 15.0;
    }
    add(ekf, sample);
  }
  EXPECT_GT(ekf.counters().wheel_downweighted, 10u);
  expect_near_truth(ekf, drive);
}

TEST(EkfConfig, NamesTheFieldThatBreaksItsRule) {
  EXPECT_TRUE(EkfConfig{}.validate());
  const auto broken = [](auto change) {
    EkfConfig config;
    change(config);
    const auto status = config.validate();
    return status ? std::string() : status.error().message.substr(0, status.error().message.find(':'));
  };
  EXPECT_EQ(broken([](EkfConfig& c) { c.imu.gyro_noise = 0.0; }), "imu.gyro_noise");
  EXPECT_EQ(broken([](EkfConfig& c) { c.gps.correlation_time = -1.0; }), "gps.correlation_time");
  EXPECT_EQ(broken([](EkfConfig& c) { c.gps.correlated_share = 1.0; }), "gps.correlated_share");
  EXPECT_EQ(broken([](EkfConfig& c) { c.gps.initial_fixes = 0; }), "gps.initial_fixes");
  EXPECT_EQ(broken([](EkfConfig& c) { c.max_lateness = 9.0; }), "max_lateness");
  EXPECT_EQ(broken([](EkfConfig& c) { c.mounting.p_base_antenna.x() = kNaN<double>; }),
            "mounting.p_base_antenna");
  EXPECT_EQ(broken([](EkfConfig& c) { c.site_origin = GeoPoint{49.0, 8.4, 0.0}; }), "site_origin");
}

}  // namespace
}  // namespace fleetmap::localization
