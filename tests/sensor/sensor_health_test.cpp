#include "fleetmap/sensor/sensor_health.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "fleetmap/geometry/degree.hpp"
#include "sensor/stamps.hpp"

namespace fleetmap::sensor {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// The k-th of 100 samples a second of a robot that shakes a little and turns about z.
Imu sample(int k, double rate = 0.0) {
  Imu imu;
  imu.stamp = kStart + std::chrono::milliseconds(10 * k);
  imu.specific_force = {0.4 * std::sin(k), 0.3 * std::cos(3.0 * k), 9.81 + 0.5 * std::sin(0.7 * k)};
  imu.angular_velocity = {0.01 * std::sin(k), 0.0, rate};
  return imu;
}

Wheel wheel(int k, double speed, double yaw_rate, std::optional<Pose> T_odom_base = {}) {
  return {kStart + std::chrono::milliseconds(10 * k), speed, yaw_rate, T_odom_base};
}

TEST(SensorHealth, SoundSamplesStayAsTheyAre) {
  SensorHealth health;
  for (int k = 0; k < 500; ++k) {
    const Imu before = sample(k, 2.0 * std::sin(0.02 * k));
    Imu imu = before;
    Wheel turn = wheel(k, 1.0, 2.0 * std::sin(0.02 * k));
    EXPECT_TRUE(health.check(turn));
    EXPECT_TRUE(health.check(imu));
    EXPECT_EQ(imu.specific_force, before.specific_force);
    EXPECT_EQ(imu.angular_velocity, before.angular_velocity);
    EXPECT_EQ(turn.forward_speed, 1.0);
  }
  EXPECT_THAT(health.findings(), IsEmpty());
}

TEST(SensorHealth, AccelerationsInGAndMilliGAreConvertedFromTheFirstSampleOn) {
  for (const double unit : {9.80665, 9.80665e-3}) {
    SensorHealth health;
    for (int k = 0; k < 200; ++k) {
      Imu imu = sample(k);
      const Eigen::Vector3d truth = imu.specific_force;
      imu.specific_force /= unit;
      EXPECT_TRUE(health.check(imu));
      EXPECT_NEAR((imu.specific_force - truth).norm(), 0.0, 1e-9) << k;
    }
    EXPECT_THAT(health.take_warnings(),
                ElementsAre(HasSubstr(unit > 1.0 ? "unit is g " : "unit is milli-g ")));
    EXPECT_THAT(health.take_warnings(), IsEmpty()) << "said once";
  }
}

TEST(SensorHealth, AnAccelerationThatIsNoGravityIsNamedAndNotTouched) {
  SensorHealth nothing, odd;
  for (int k = 0; k < 50; ++k) {
    Imu imu = sample(k);
    imu.specific_force.setZero();
    EXPECT_TRUE(nothing.check(imu));
    imu.specific_force = Eigen::Vector3d(0.0, 0.0, 32.2);  // feet
    EXPECT_TRUE(odd.check(imu));
    EXPECT_EQ(imu.specific_force.z(), 32.2);
  }
  EXPECT_THAT(nothing.findings(), ElementsAre(HasSubstr("acceleration is 0")));
  EXPECT_THAT(odd.findings(), ElementsAre(HasSubstr("acceleration is 32.2")));
}

TEST(SensorHealth, DegreesASecondAreKnownByARateThatNoRobotTurnsAt) {
  SensorHealth health;
  double used = 0.0;
  for (int k = 0; k < 300; ++k) {
    Imu imu = sample(k, k < 100 ? 0.0 : 0.5 / kDegree);
    if (health.check(imu)) used = std::max(used, imu.angular_velocity.z());
  }
  EXPECT_THAT(health.findings(), ElementsAre(HasSubstr("deg/s")));
  EXPECT_NEAR(used, 0.5, 1e-9) << "none was used as it came";
  EXPECT_LT(health.refused(), 10u);
}

TEST(SensorHealth, DegreesASecondOfASlowTurnAreKnownByTheWheels) {
  SensorHealth health;
  Imu last;
  for (int k = 0; k < 300; ++k) {
    Wheel turn = wheel(k, 0.5, 0.1);
    EXPECT_TRUE(health.check(turn));
    last = sample(k, 0.1 / kDegree);
    EXPECT_EQ(health.check(last), k >= 49) << "refused until it is certain";
  }
  EXPECT_THAT(health.findings(), ElementsAre(HasSubstr("times as fast as the wheels")));
  EXPECT_NEAR(last.angular_velocity.z(), 0.1, 1e-9);
}

TEST(SensorHealth, ASingleImpossibleRateIsAnErrorOfTheSensorAndNoUnit) {
  SensorHealth health;
  for (int k = 0; k < 300; ++k) {
    Imu imu = sample(k, k % 50 == 49 ? 30.0 : 0.3);
    EXPECT_EQ(health.check(imu), k % 50 != 49);
  }
  EXPECT_THAT(health.findings(), IsEmpty());
}

TEST(SensorHealth, SpeedComesFromThePoseWhereTheTwistIsNotFilled) {
  SensorHealth health;
  Pose T = make_pose(rotation_from_rpy(0.0, 0.0, 0.4), Eigen::Vector3d(3.0, 4.0, 0.0));
  for (int k = 0; k < 100; ++k) {
    Wheel odometry = wheel(k, 0.0, 0.0, T);
    ASSERT_TRUE(health.check(odometry));
    if (k > 0) {
      EXPECT_NEAR(odometry.forward_speed, 1.5, 0.01);
      EXPECT_NEAR(odometry.yaw_rate.value(), 0.2, 1e-6);
    }
    T = T * make_pose(rotation_from_rpy(0.0, 0.0, 0.002), Eigen::Vector3d(0.015, 0.0, 0.0));
  }
  EXPECT_THAT(health.findings(), ElementsAre(HasSubstr("pose moves while its twist is zero")));
}

TEST(SensorHealth, ARobotThatStandsOrWhosePoseIsNotFilledIsTakenAsItIs) {
  SensorHealth health;
  for (int k = 0; k < 100; ++k) {
    Wheel standing = wheel(k, 0.0, 0.0, Pose::Identity());
    Wheel driving = wheel(100 + k, 1.0, 0.0, Pose::Identity());
    EXPECT_TRUE(health.check(standing));
    EXPECT_EQ(standing.forward_speed, 0.0);
    EXPECT_TRUE(health.check(driving));
    EXPECT_EQ(driving.forward_speed, 1.0);
  }
  EXPECT_THAT(health.findings(), IsEmpty());
}

TEST(SensorHealth, APoseThatJumpsIsNoSpeed) {
  SensorHealth health;
  Wheel before = wheel(0, 0.0, 0.0, Pose::Identity());
  Wheel after = wheel(1, 0.0, 0.0, make_pose(Eigen::Quaterniond::Identity(), Eigen::Vector3d(5.0, 0.0, 0.0)));
  EXPECT_TRUE(health.check(before));
  EXPECT_FALSE(health.check(after));
  EXPECT_EQ(health.refused(), 1u);
}

TEST(SensorHealth, ScansThatTheNetworkLostAreNamed) {
  const Duration sweep = std::chrono::milliseconds(98);
  SensorHealth all, half_a_sweep, lossy;
  for (int k = 0; k < 600; ++k) {
    const Stamp stamp = kStart + std::chrono::milliseconds(100 * k);
    all.check_scan(stamp, sweep);
    if (k % 100 != 7) half_a_sweep.check_scan(stamp, sweep * 6 / 10);
    if (k % 6 == 0) lossy.check_scan(stamp, sweep);
  }
  EXPECT_THAT(all.findings(), IsEmpty());
  EXPECT_THAT(half_a_sweep.findings(), IsEmpty()) << "one of a hundred";
  EXPECT_THAT(lossy.findings(), ElementsAre(HasSubstr("scans are missing")));
  EXPECT_NEAR(static_cast<double>(lossy.missing_scans()), 495.0, 5.0);
  EXPECT_EQ(all.missing_scans(), 0u);
}

TEST(SensorHealth, ScansWithoutPointTimesAreMissedByTheIntervalsBetweenThem) {
  SensorHealth all, jittery, lossy, later;
  std::mt19937 random(7);
  std::normal_distribution<double> jitter(0.0, 0.015);
  for (int k = 0; k < 600; ++k) {
    const Stamp stamp = kStart + std::chrono::milliseconds(100 * k);
    all.check_scan(stamp, {});
    jittery.check_scan(stamp + from_seconds(std::clamp(jitter(random), -0.04, 0.04)), {});
    const bool arrives = random() % 6 == 0;
    if (arrives) lossy.check_scan(stamp, {});
    if (arrives || k < 100) later.check_scan(stamp, {});
  }
  EXPECT_THAT(all.findings(), IsEmpty());
  EXPECT_THAT(jittery.findings(), IsEmpty());
  EXPECT_THAT(lossy.findings(), ElementsAre(HasSubstr("scans are missing: the closest are 0.1 s apart")));
  EXPECT_THAT(later.findings(), ElementsAre(HasSubstr("scans are missing")));
  EXPECT_EQ(all.missing_scans(), 0u);
}

TEST(SensorHealth, ALidarThatWasOffForAWhileLostNothing) {
  SensorHealth health;
  for (int k = 0; k < 200; ++k)
    health.check_scan(kStart + std::chrono::milliseconds(100 * k + (k < 100 ? 0 : 30'000)),
                      std::chrono::milliseconds(98));
  EXPECT_THAT(health.findings(), IsEmpty());
  EXPECT_EQ(health.missing_scans(), 0u);
}

TEST(SensorHealth, DegreesThatWereFoundBeforeAreConvertedFromTheFirstSampleOn) {
  SensorHealth health;
  health.expect_degrees("it turns 57 times as fast as the wheels");
  Imu imu = sample(0, 0.5 / kDegree);
  EXPECT_TRUE(health.check(imu));
  EXPECT_NEAR(imu.angular_velocity.z(), 0.5, 1e-9);
  EXPECT_THAT(health.take_warnings(), ElementsAre(HasSubstr("57 times as fast as the wheels, so the unit")));
}

TEST(SensorHealth, AnImuThatIsUpsideDownOrLiesOnItsSideIsNamedWithTheTurnThatIsMissing) {
  for (const auto& [roll, text] :
       {std::pair(180.0, "gravity is 180 deg"), {-90.0, "turned by [90, "}, {15.0, ""}}) {
    for (const bool stated : {false, true}) {
      const Eigen::Quaterniond q_base_imu(rotation_from_rpy(-roll * kDegree, 0.0, 0.0));
      SensorHealth health;
      if (stated) health.set_imu_rotation(q_base_imu);
      for (int k = 0; k < 50; ++k) {
        Imu imu = sample(k);
        imu.specific_force = q_base_imu.inverse() * Eigen::Vector3d(0.0, 0.0, 9.81);
        health.check(imu);
      }
      const bool silent = stated || *text == '\0';
      if (silent) {
        EXPECT_THAT(health.findings(), IsEmpty()) << roll;
      } else {
        EXPECT_THAT(health.findings(),
                    ElementsAre(AllOf(HasSubstr(text), HasSubstr("Gravity does not show yaw"))))
            << roll;
      }
    }
  }
}

TEST(SensorHealth, AnImuWithGapsIsNamedAndOneThatWasOffIsNot) {
  SensorHealth gaps, off;
  for (int k = 0; k < 3000; ++k) {
    Imu imu = sample(k);
    if (k % 300 < 200) gaps.check(imu);
    imu = sample(k < 1000 ? k : k + 2000);
    off.check(imu);
  }
  EXPECT_THAT(gaps.findings(), ElementsAre(HasSubstr("IMU: samples are missing")));
  EXPECT_THAT(off.findings(), IsEmpty());
}

TEST(SensorHealth, FixesOfAReceiverWithoutAPlaceAreRefused) {
  SensorHealth health;
  Fix nowhere{.stamp = kStart, .position = {}};
  EXPECT_FALSE(health.check(nowhere));
  EXPECT_THAT(health.take_warnings(), ElementsAre(HasSubstr("latitude 0, longitude 0")));
  nowhere.valid = false;
  EXPECT_TRUE(health.check(nowhere)) << "it says so itself, and the filter counts it";
}

TEST(SensorHealth, FixesWithoutAltitudeAreNamed) {
  SensorHealth health;
  Fix fix;
  fix.position = {0.7, -0.1, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_FALSE(health.check(fix));
  EXPECT_FALSE(health.check(fix));
  EXPECT_THAT(health.findings(), ElementsAre(HasSubstr("no altitude")));
  fix.position.altitude = 600.0;
  EXPECT_TRUE(health.check(fix));
}

TEST(SensorHealth, FixesThatRiseAreCorrectedAndOnesThatEndAreNoted) {
  SensorHealth health;
  Fix fix;
  for (int k = 0; k < 1000; ++k) {
    const double t = 0.1 * k;
    if (k % 2 == 0 && t < 80.0) {
      fix = {.stamp = at(t), .position = {0.7, -0.1, t < 20.0 ? 600.0 : 640.0}};
      fix.covariance.setIdentity();
      EXPECT_TRUE(health.check(fix));
      if (t < 20.0 || t > 26.0) {
        EXPECT_NEAR(fix.position.altitude, 600.0, 1e-6) << t;
      }
    }
    health.check_scan(at(t), std::chrono::milliseconds(98));
    health.check_motion(at(t), Pose::Identity());
  }
  EXPECT_THAT(health.findings(), ElementsAre(HasSubstr("its height jumped by 40 m")));
  EXPECT_THAT(health.gaps(), ElementsAre("GPS: no fix from 80 s to 100 s of the drive, its end"));
}

TEST(SensorHealth, FixesThatEndAreFoundWithoutALidarAndWhileTheOdometryIsLost) {
  for (const bool has_lidar : {false, true}) {
    SensorHealth health;
    for (int k = 0; k < 1000; ++k) {
      if (k % 2 == 0 && k < 200) {
        Fix fix{.stamp = at(0.1 * k), .position = {0.7, -0.1, 600.0}};
        EXPECT_TRUE(health.check(fix));
      }
      Imu imu;
      imu.stamp = at(0.1 * k);
      imu.specific_force = {0.0, 0.0, 9.81};
      health.check(imu);
      if (!has_lidar) continue;
      health.check_scan(at(0.1 * k), std::chrono::milliseconds(98));
      health.check_motion(at(0.1 * k), std::nullopt);
    }
    EXPECT_THAT(health.findings(), Contains(HasSubstr("GPS: no fix since 20 s"))) << has_lidar;
  }
}

TEST(SensorHealth, GroundThatIsTiltedInTheMedianOfManyScansNamesTheMount) {
  for (const double pitch : {0.0, 3.0, -20.0}) {
    SensorHealth health;
    const Eigen::Vector3d normal =
        rotation_from_rpy(0.0, pitch * std::numbers::pi / 180.0, 0.0) * Eigen::Vector3d::UnitZ();
    int asked = 0;
    for (int scan = 0; scan < 400; ++scan) {
      if (!health.ground_due()) continue;
      // Now and then an embankment is taken for the ground.
      health.check_ground(++asked % 4 == 0 ? Eigen::Vector3d(0.6, 0.0, 0.8) : normal);
    }
    EXPECT_EQ(asked, 40);
    const auto news = health.take_warnings();
    ASSERT_EQ(news.size(), pitch < -5.0 ? 1u : 0u) << pitch;
    if (news.empty()) continue;
    EXPECT_THAT(news[0], HasSubstr("tilted by 20 deg"));
    EXPECT_THAT(news[0], HasSubstr(", 20, 0] deg more"));
  }
}

}  // namespace
}  // namespace fleetmap::sensor
