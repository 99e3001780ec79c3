#include "fleetmap/sensor/motion_agreement.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "sensor/stamps.hpp"

namespace fleetmap::sensor {
namespace {

using ::testing::ContainsRegex;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

/// A robot that drives 1 m/s and swings to either side; what its sensors have wrong.
struct SwayingRobot {
  double wheel_scale = 1.0, wheel_turn_scale = 1.0;
  Eigen::Matrix3d R_imu_base = Eigen::Matrix3d::Identity();  ///< that the driver does not know of
  double gyro_scale = 1.0, gyro_late = 0.0;                  ///< late: s
  double lidar_yaw = 0.0, lidar_turn_sign = 1.0;
  double fault_from = 0.0;  ///< s; all is right before
  bool with_gyro = true, with_wheels = true, lost = false;

  static double rate(double t) { return 0.4 * std::sin(0.9 * t); }

  double fault_until = 1e9;  ///< s, of the wheels' speed
  double seconds = 60.0, speed = 1.0;

  std::vector<std::string> findings() const { return driven().take_findings(); }
  MotionAgreement driven() const {
    MotionAgreement agreement;
    Pose T = Pose::Identity();
    const Pose T_base_wrong = make_pose(rotation_from_rpy(0.0, 0.0, lidar_yaw), Eigen::Vector3d::Zero());
    for (int k = 0; k < static_cast<int>(100.0 * seconds); ++k) {
      const double t = 0.01 * k;
      const bool faulty = t >= fault_from;
      Imu imu;
      imu.stamp = at(faulty ? t + gyro_late : t);
      imu.angular_velocity = Eigen::Vector3d(0.0, 0.0, rate(t));
      if (faulty) imu.angular_velocity = gyro_scale * (R_imu_base * imu.angular_velocity);
      if (with_gyro) agreement.add(imu);
      if (with_wheels && k % 5 == 0)
        agreement.add(Wheel{.stamp = at(t),
                            .forward_speed = (faulty && t < fault_until ? wheel_scale : 1.0) * speed,
                            .yaw_rate = (faulty ? wheel_turn_scale : 1.0) * rate(t)});
      if (lost && faulty) agreement.interrupt();
      if (k % 10 == 0) agreement.add_motion(at(t), T_base_wrong.inverse() * T * T_base_wrong);
      T = T * make_pose(rotation_from_rpy(0.0, 0.0, lidar_turn_sign * 0.01 * rate(t)),
                        Eigen::Vector3d(0.01 * speed, 0.0, 0.0));
    }
    return agreement;
  }
};

TEST(MotionAgreement, IsSilentWhereAllAgreeOrNothingIsCompared) {
  EXPECT_THAT(SwayingRobot{}.findings(), IsEmpty());
  EXPECT_THAT((SwayingRobot{.with_gyro = false, .with_wheels = false}.findings()), IsEmpty());
  EXPECT_THAT((SwayingRobot{.wheel_scale = 1.1, .wheel_turn_scale = 0.7, .gyro_scale = 1.03}.findings()),
              IsEmpty())
      << "tyres, skid steering and a cheap gyro";
}

TEST(MotionAgreement, SaysWhatWasNotComparedAndHowFarTheRobotMoved) {
  EXPECT_EQ(SwayingRobot{}.driven().not_compared(), std::nullopt);
  EXPECT_EQ((SwayingRobot{.with_wheels = false}.driven().not_compared()), std::nullopt);
  EXPECT_THAT((SwayingRobot{.with_gyro = false, .with_wheels = false}.driven().not_compared().value_or("")),
              HasSubstr("neither the IMU nor wheels"));
  EXPECT_THAT((SwayingRobot{.seconds = 2.0}.driven().not_compared().value_or("")),
              ContainsRegex("the speed of the wheels, turns, stamps: .* drove 1\\.[0-9]+ m and turned by"));
  EXPECT_THAT((SwayingRobot{.speed = 0.1}.driven().not_compared().value_or("")),
              StartsWith("the speed of the wheels: "))
      << "it turned nearly on the spot";
}

TEST(MotionAgreement, TheUnitAndTheSignOfTheWheelsAreNamed) {
  EXPECT_THAT((SwayingRobot{.wheel_scale = 3.6}.findings()), ElementsAre(HasSubstr("km/h")));
  EXPECT_THAT((SwayingRobot{.wheel_scale = 1000.0}.findings()), ElementsAre(HasSubstr("mm/s")));
  EXPECT_THAT((SwayingRobot{.wheel_scale = 1.5}.findings()), ElementsAre(HasSubstr("diameter")));
  EXPECT_THAT((SwayingRobot{.wheel_scale = -1.0}.findings()), ElementsAre(HasSubstr("drives backwards")));
  EXPECT_THAT((SwayingRobot{.wheel_scale = 0.0}.findings()), ElementsAre(HasSubstr("it stands while")));
  EXPECT_THAT((SwayingRobot{.wheel_turn_scale = -1.0}.findings()),
              ElementsAre(HasSubstr("sign of twist.angular.z")));
  EXPECT_THAT((SwayingRobot{.wheel_turn_scale = 0.0}.findings()),
              ElementsAre(HasSubstr("angular.z is not filled")));
  EXPECT_THAT((SwayingRobot{.wheel_turn_scale = 57.3}.findings()),
              ElementsAre(HasSubstr("the unit or the track width")));
}

TEST(MotionAgreement, TheYawOfTheLidarIsNamedWithItsSign) {
  // A LiDAR turned to the left by 90 deg, unknown to the configuration, sees the robot move to its right.
  EXPECT_THAT(
      (SwayingRobot{.lidar_yaw = 0.5 * std::numbers::pi}.findings()),
      ElementsAre(ContainsRegex("(89\\.[0-9]|90|90\\.[0-9]) deg to the right of where the wheels drive.*"
                                "should have (89\\.[0-9]|90|90\\.[0-9]) deg more yaw")));
  EXPECT_THAT((SwayingRobot{.lidar_yaw = 0.1}.findings()), IsEmpty());
}

TEST(MotionAgreement, AxesAndSignsOfTheGyroAreNamed) {
  Eigen::Matrix3d swapped;
  swapped << 0, 0, 1, 0, 1, 0, 1, 0, 0;  // x and z
  EXPECT_THAT((SwayingRobot{.R_imu_base = swapped}.findings()),
              ElementsAre(HasSubstr("turns about x: its axes are swapped")));
  EXPECT_THAT((SwayingRobot{.R_imu_base = -swapped}.findings()),
              ElementsAre(HasSubstr("turns about minus x")));
  EXPECT_THAT((SwayingRobot{.gyro_scale = -1.0}.findings()),
              ElementsAre(HasSubstr("the sign of its z axis")));
  EXPECT_THAT((SwayingRobot{.gyro_scale = 0.5}.findings()),
              ElementsAre(HasSubstr("0.5 times as fast as LiDAR and wheels")));
  EXPECT_THAT((SwayingRobot{.gyro_scale = 0.0, .with_wheels = false}.findings()),
              ElementsAre(HasSubstr("as fast as the LiDAR")));
}

TEST(MotionAgreement, WhereTheOdometryIsLostTheWheelsNameTheGyro) {
  EXPECT_THAT((SwayingRobot{.gyro_scale = -1.0, .lost = true}.findings()),
              ElementsAre(HasSubstr("turns right where the wheels turn left")));
  EXPECT_THAT(SwayingRobot{.lost = true}.findings(), IsEmpty());
  EXPECT_THAT((SwayingRobot{.wheel_turn_scale = 0.6, .lost = true}.findings()), IsEmpty()) << "skid steering";
}

TEST(MotionAgreement, ALidarThatTwoContradictIsMirrored) {
  EXPECT_THAT((SwayingRobot{.lidar_turn_sign = -1.0}.findings()), ElementsAre(HasSubstr("mirrored")));
}

TEST(MotionAgreement, StampsThatAreWrongByATenthOfASecondAreNamed) {
  EXPECT_THAT((SwayingRobot{.gyro_late = 0.1}.findings()), ElementsAre(HasSubstr("100 ms after the LiDAR")));
  EXPECT_THAT((SwayingRobot{.gyro_late = -0.2}.findings()),
              ElementsAre(HasSubstr("200 ms before the LiDAR")));
  EXPECT_THAT((SwayingRobot{.gyro_late = 0.02}.findings()), IsEmpty());
}

TEST(MotionAgreement, FaultsThatBeginAfterTheFirstCheckAreNamedOnceWithTheirTime) {
  const std::string since =
      "since 2023-11-14T22:13:(39|4[0-9])";  // the window of the 22nd second or the next
  EXPECT_THAT((SwayingRobot{.wheel_scale = 3.0, .fault_from = 22.0}.findings()),
              ElementsAre(ContainsRegex("wheel odometry: it is 3 times as fast as the LiDAR " + since)));
  EXPECT_THAT((SwayingRobot{.wheel_scale = 0.0, .fault_from = 22.0}.findings()),
              ElementsAre(ContainsRegex("it stands while the LiDAR moves " + since)));
  EXPECT_THAT((SwayingRobot{.gyro_scale = 0.0, .fault_from = 22.0}.findings()),
              ElementsAre(ContainsRegex("its gyro turns 0 times as fast as .* " + since)));
  EXPECT_THAT((SwayingRobot{.wheel_turn_scale = -1.0, .fault_from = 22.0}.findings()),
              ElementsAre(ContainsRegex("sign of twist.angular.z is wrong.* " + since)));
}

TEST(MotionAgreement, WheelsThatSlipForSomeMetresAreNotNamed) {
  EXPECT_THAT((SwayingRobot{.wheel_scale = 4.0, .fault_from = 22.0, .fault_until = 30.0}.findings()),
              IsEmpty());
  EXPECT_THAT((SwayingRobot{.wheel_scale = 1.4, .fault_from = 22.0}.findings()), IsEmpty())
      << "a slope of mud";
}

TEST(MotionAgreement, StampsThatAreWrongFromAMomentOnAreNamedAlsoWhereTheOdometryIsLost) {
  for (const double late : {-0.25, 0.25}) {
    const std::string when = late > 0.0 ? "after" : "before";
    EXPECT_THAT((SwayingRobot{.gyro_late = late, .fault_from = 28.0}.findings()),
                ElementsAre(ContainsRegex("clocks: the gyro turns 2[456]0 ms " + when +
                                          " .*, by the stamps, since 2023")));
    EXPECT_THAT((SwayingRobot{.gyro_late = late, .fault_from = 28.0, .lost = true}.findings()),
                ElementsAre(ContainsRegex("clocks: the gyro turns 2[456]0 ms " + when +
                                          " the wheels, by the stamps, since")));
  }
}

}  // namespace
}  // namespace fleetmap::sensor
