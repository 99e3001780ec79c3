#include "recordings/calibrated_mounts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "fleetmap/geometry/degree.hpp"
#include "sensor/made_drive.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const CalibratedQuantity& quantity(const CalibratedMounts& mounts, const std::string& sensor,
                                   const std::string& name) {
  return *std::ranges::find_if(mounts.quantities, [&](const CalibratedQuantity& one) {
    return one.sensor == sensor && one.name == name;
  });
}

const CalibratedPlace& place_of(const CalibratedMounts& mounts, const std::string& section) {
  return *std::ranges::find(mounts.places, section, &CalibratedPlace::section);
}

/// The mounts in use are wrong by what made_drive() drew.
TEST(CalibratedMounts, MovesAllMountsIntoTheBaseOfTheWheels) {
  const sensor::MadeDrive made =
      sensor::made_drive(2, {.seconds = 60.0, .gps_white = 0.02, .gps_slow = 0.02});
  SensorPlaces in_use;
  in_use.T_base_lidar = make_pose(rotation_from_rpy(0.0, 0.1, 0.2), Eigen::Vector3d(0.1, 0.0, 0.8));
  const CalibratedMounts mounts = calibrate_mounts(made.drive, in_use);
  ASSERT_THAT(mounts.skipped, IsEmpty());
  const Pose lidar = made.T_wheels_base * in_use.T_base_lidar, imu = made.T_wheels_base * made.T_base_imu;
  const Eigen::Vector3d antenna = made.T_wheels_base * made.p_base_antenna;
  const Pose& found = place_of(mounts, "lidar").T_base_sensor;
  EXPECT_LT((found.translation() - lidar.translation()).head<2>().norm(), 0.03);
  EXPECT_EQ(found.translation().z(), 0.8) << "wheels do not show the height";
  EXPECT_LT(so3_log(found.linear().transpose() * lidar.linear()).norm(), 0.01);
  const Pose& found_imu = place_of(mounts, "imu").T_base_sensor;
  EXPECT_LT(so3_log(found_imu.linear().transpose() * imu.linear()).norm(), 0.02);
  EXPECT_LT((found_imu.translation() - imu.translation()).head<2>().norm(), 0.05);
  EXPECT_LT((place_of(mounts, "gps").T_base_sensor.translation() - antenna).head<2>().norm(), 0.1);
  EXPECT_GT(mounts.metres, 50.0);
  EXPECT_GT(mounts.turned, 20.0);
}

TEST(CalibratedMounts, AnErrorOfTheTurnMovesALidarThatIsFarFromTheBase) {
  const sensor::MadeDrive made = sensor::made_drive(2, {.seconds = 60.0});
  SensorPlaces near, far;
  far.T_base_lidar = make_pose(Eigen::Matrix3d::Identity(), Eigen::Vector3d(20.0, 0.0, 0.0));
  const CalibratedMounts at_base = calibrate_mounts(made.drive, near),
                         ahead = calibrate_mounts(made.drive, far);
  const double turn = quantity(ahead, "LiDAR", "turn about z against its mount in use").estimate.sigma;
  const double sideways = quantity(at_base, "LiDAR", "y").estimate.sigma;
  EXPECT_GT(quantity(ahead, "LiDAR", "y").estimate.sigma, 0.8 * 20.0 * turn * kDegree);
  EXPECT_LT(sideways, 0.5 * 20.0 * turn * kDegree);
}

TEST(CalibratedMounts, AfterALargeTurnOfTheLidarTheOthersWaitForASecondRun) {
  sensor::MadeDrive made = sensor::made_drive(2, {.seconds = 60.0});
  const Pose T_turned = make_pose(rotation_from_rpy(0.0, 0.0, 1.0), Eigen::Vector3d::Zero());
  for (auto& pose : made.drive.track) pose.T_odom_base = pose.T_odom_base * T_turned;
  const CalibratedMounts mounts = calibrate_mounts(made.drive, {});
  ASSERT_EQ(mounts.places.size(), 1u);
  EXPECT_EQ(mounts.places.front().section, "lidar");
  EXPECT_THAT(mounts.skipped, Contains(HasSubstr("calibrate again")));
}

TEST(CalibratedMounts, NamesWhatDiffersFromTheMountInUse) {
  sensor::MadeDrive made = sensor::made_drive(4, {.seconds = 60.0});
  made.drive.wheels.clear();
  SensorPlaces in_use;
  in_use.T_base_imu = made.T_base_imu;
  in_use.T_base_imu.translation().x() += 0.2;
  in_use.T_base_imu.linear() = so3_exp({0.0, 0.0, -0.1}) * in_use.T_base_imu.linear();
  const CalibratedMounts mounts = calibrate_mounts(made.drive, in_use);
  EXPECT_TRUE(quantity(mounts, "IMU", "x").differs());
  EXPECT_TRUE(quantity(mounts, "IMU", "turn about z against its mount in use").differs());
  EXPECT_FALSE(quantity(mounts, "IMU", "turn about x against its mount in use").differs());
  EXPECT_THAT(mounts.skipped, Contains(HasSubstr("no wheel odometry: drive two figures of eight")));
}

TEST(CalibratedMounts, AStraightDriveShowsYawOfTheLidarAlone) {
  const sensor::MadeDrive made = sensor::made_drive(3, {.seconds = 60.0, .turn_rate = 0.0});
  const CalibratedMounts mounts = calibrate_mounts(made.drive, {});
  EXPECT_TRUE(quantity(mounts, "LiDAR", "turn about z against its mount in use").observable);
  EXPECT_FALSE(quantity(mounts, "LiDAR", "x").observable);
  EXPECT_EQ(quantity(mounts, "LiDAR", "x").remedy, "drive two figures of eight");
  EXPECT_EQ(mounts.places.size(), 1u);
  EXPECT_THAT(place_of(mounts, "lidar").kept, HasSubstr("x, y, z"));
  EXPECT_THAT(mounts.skipped, Contains(HasSubstr("IMU: not observable on this drive")));
}

}  // namespace
}  // namespace fleetmap::apps
