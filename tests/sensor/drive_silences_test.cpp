#include "fleetmap/sensor/drive_silences.hpp"

#include <gmock/gmock.h>

#include <random>

#include "sensor/stamps.hpp"

namespace fleetmap::sensor {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// 40 s by scans of 10 Hz at 1 m/s, with fixes and wheels at 5 Hz until so many seconds.
DriveSilences driven(int fixes_until, int wheels_until) {
  DriveSilences silences;
  for (int k = 0; k <= 400; ++k) {
    silences.pass(at(0.1 * k), Eigen::Vector3d(0.1 * k, 0.0, 0.0));
    if (k % 2 == 0 && k <= 10 * fixes_until) silences.add_fix(at(0.1 * k));
    if (k % 2 == 0 && k <= 10 * wheels_until) silences.add_wheel(at(0.1 * k));
  }
  return silences;
}

TEST(DriveSilences, FixesAndWheelsThatComeAreNoSilence) {
  DriveSilences silences = driven(40, 40);
  EXPECT_THAT(silences.take_findings(), IsEmpty());
  EXPECT_THAT(silences.notes(), IsEmpty());
}

TEST(DriveSilences, EachIsNamedAndItsFindingComesOnce) {
  DriveSilences silences = driven(30, 10);
  EXPECT_THAT(silences.notes(), ElementsAre(HasSubstr("GPS: no fix from 30 s to 40 s"),
                                            HasSubstr("wheel odometry: no sample from 10 s to 40 s")));
  EXPECT_THAT(silences.take_findings(), ElementsAre(HasSubstr("wheel odometry: no sample since 10 s")));
  EXPECT_THAT(silences.take_findings(), IsEmpty());
}

TEST(DriveSilences, WheelsOfARobotThatStandsMayBeSilent) {
  DriveSilences silences;
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 0.003);
  for (int k = 0; k < 3000; ++k) {
    silences.pass(at(0.1 * k), Eigen::Vector3d(noise(random), noise(random), noise(random)));
    if (k < 100) silences.add_wheel(at(0.1 * k));
  }
  EXPECT_THAT(silences.take_findings(), IsEmpty());
  for (int k = 3000; k < 3100; ++k) silences.pass_lost(at(0.1 * k));
  EXPECT_THAT(silences.take_findings(), ElementsAre(HasSubstr("wheel odometry: no sample since 10 s")));
}

TEST(DriveSilences, AStampThatJumpsIsNoSilence) {
  DriveSilences silences = driven(40, 40);
  silences.pass(at(3640.0), Eigen::Vector3d(40.0, 0.0, 0.0));
  EXPECT_THAT(silences.notes(), IsEmpty());
}

}  // namespace
}  // namespace fleetmap::sensor
