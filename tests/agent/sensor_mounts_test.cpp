#include "fleetmap/agent/sensor_mounts.hpp"

#include <gmock/gmock.h>

#include <numbers>

#include "support/robots.hpp"

namespace fleetmap::agent {
namespace {

using fleetmap::testing::kStart;
using namespace std::chrono_literals;
using sensor::Source;
using State = SensorMounts::State;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kDegree = std::numbers::pi / 180.0;
const Eigen::Quaterniond kPitched(rotation_from_rpy(0.0, 20.0 * kDegree, 0.0));
const sensor::FrameTransform kMast{"base_link", "mast", {0.2, 0.0, 0.5}};
const sensor::FrameTransform kLidar{"mast", "velodyne", {0.0, 0.0, 0.3}, kPitched};

PerceptionConfig stated(double height) {
  PerceptionConfig config;
  config.odometry.T_base_lidar.translation() = Eigen::Vector3d(0.2, 0.0, height);
  config.odometry.T_base_lidar.linear() = kPitched.toRotationMatrix();
  config.mount_configured[0] = true;
  return config;
}

TEST(SensorMounts, DefaultMountsAreThoseOfTheFrames) {
  PerceptionConfig config;
  SensorMounts mounts(config);
  mounts.add({kMast, kLidar, {"mast", "imu_link", {}, kPitched}, {"base_link", "antenna", {0.0, 0.1, 1.0}}});
  EXPECT_EQ(mounts.on_message(Source::kLidar, "/velodyne", kStart), State::kDecided);
  EXPECT_EQ(mounts.on_message(Source::kImu, "imu_link", kStart), State::kDecided);
  EXPECT_EQ(mounts.on_message(Source::kGps, "antenna", kStart), State::kDecided);
  EXPECT_EQ(mounts.on_message(Source::kWheel, "odom", kStart), State::kKnown);
  EXPECT_EQ(mounts.on_message(Source::kLidar, "velodyne", kStart), State::kKnown);
  mounts.apply_to(config);
  EXPECT_TRUE(config.odometry.T_base_lidar.translation().isApprox(Eigen::Vector3d(0.2, 0.0, 0.8)));
  EXPECT_TRUE(config.odometry.T_base_lidar.linear().isApprox(kPitched.toRotationMatrix(), 1e-12));
  EXPECT_TRUE(config.localization.mounting.T_base_imu.linear().isApprox(kPitched.toRotationMatrix(), 1e-12));
  EXPECT_LT(config.odometry.q_base_imu.angularDistance(kPitched), 1e-9);
  EXPECT_EQ(config.localization.mounting.p_base_antenna, Eigen::Vector3d(0.0, 0.1, 1.0));
  EXPECT_THAT(mounts.take_warnings(), IsEmpty());
  EXPECT_THAT(mounts.summaries()[0],
              AllOf(HasSubstr("[0.200, 0.000, 0.800] m, [0.0, 20.0, 0.0] deg"), HasSubstr("by /tf_static")));
}

TEST(SensorMounts, AConfiguredOneIsUsedAndADifferenceIsAWarning) {
  PerceptionConfig config = stated(1.0);
  SensorMounts mounts(config);
  mounts.add({kMast, kLidar});
  EXPECT_EQ(mounts.on_message(Source::kLidar, "velodyne", kStart), State::kDecided);
  mounts.apply_to(config);
  EXPECT_EQ(config.odometry.T_base_lidar.translation().z(), 1.0);
  EXPECT_THAT(mounts.take_warnings(),
              ElementsAre(AllOf(HasSubstr("LiDAR (frame 'velodyne')"),
                                HasSubstr("0.800] m, [0.0, 20.0, 0.0] deg in /tf"),
                                HasSubstr("1.000] m, [0.0, 20.0, 0.0] deg by the configuration"),
                                HasSubstr("0.200 m and 0.0 deg apart"), HasSubstr("lidar.translation"))));
}

TEST(SensorMounts, AConfiguredOneThatAgreesIsSilentAndWaitsForNothing) {
  PerceptionConfig config = stated(0.8);
  config.frame_patience = 2s;
  SensorMounts mounts(config);
  EXPECT_EQ(mounts.on_message(Source::kLidar, "velodyne", kStart), State::kDecided);
  mounts.add({kMast, kLidar});
  EXPECT_THAT(mounts.take_warnings(), IsEmpty());
}

/// With a LiDAR that is configured, and a patience of 2 s.
PerceptionConfig patient(double height) {
  PerceptionConfig config = stated(height);
  config.frame_patience = 2s;
  return config;
}

TEST(SensorMounts, ThoseConfiguredThatNobodyPublishesAreTakenOnce) {
  PerceptionConfig config = patient(0.8);
  config.mount_configured[1] = config.mount_configured[2] = true;
  SensorMounts mounts(config);
  EXPECT_THAT(mounts.take_unpublished(kStart + 9s), IsEmpty()) << "nothing is decided";
  mounts.on_message(Source::kLidar, "/velodyne", kStart);
  mounts.on_message(Source::kImu, "base_link", kStart);  // it is there by its name
  mounts.on_message(Source::kGps, "velodyne", kStart);   // two parents of one frame are no tree
  EXPECT_THAT(mounts.take_unpublished(kStart + 1999ms), IsEmpty()) << "another may publish it";
  const auto taken = mounts.take_unpublished(kStart + 2s);
  ASSERT_EQ(taken.size(), 1u);
  EXPECT_EQ(taken[0].parent + ">" + taken[0].child, "base_link>velodyne");
  EXPECT_TRUE(taken[0].translation.isApprox(config.odometry.T_base_lidar.translation()));
  EXPECT_TRUE(taken[0].rotation.toRotationMatrix().isApprox(config.odometry.T_base_lidar.linear(), 1e-12));
  EXPECT_THAT(mounts.take_unpublished(kStart + 3s), IsEmpty());
}

/// An own transform is no source of a mount: else that of the GPS would be taken from the LiDAR's.
TEST(SensorMounts, AnOwnTransformThatComesBackIsNeitherAWarningNorAMount) {
  SensorMounts mounts(patient(0.8));
  mounts.on_message(Source::kLidar, "velodyne", kStart);
  const auto taken = mounts.take_unpublished(kStart + 2s);
  ASSERT_EQ(taken.size(), 1u);
  for (int repeated = 0; repeated < 2; ++repeated) mounts.add(taken);
  mounts.on_message(Source::kGps, "velodyne", kStart + 3s);
  EXPECT_FALSE(mounts.by_frames(Source::kGps));
  EXPECT_THAT(mounts.take_warnings(), IsEmpty());
}

TEST(SensorMounts, AGuessedOneIsNotPublished) {
  SensorMounts mounts{PerceptionConfig()};
  EXPECT_EQ(mounts.on_message(Source::kLidar, "velodyne", kStart), State::kDecided);
  EXPECT_THAT(mounts.take_unpublished(kStart + 9s), IsEmpty());
}

TEST(SensorMounts, ThoseThatSomebodyPublishesAreLeftToHim) {
  for (const bool at_once : {true, false}) {
    SensorMounts mounts(patient(0.9));
    if (at_once) mounts.add({kMast, kLidar});
    mounts.on_message(Source::kLidar, "velodyne", kStart);
    if (!at_once) mounts.add({kLidar});  // of the chain a part
    EXPECT_THAT(mounts.take_unpublished(kStart + 2s), IsEmpty()) << "though the configuration states another";
  }
}

TEST(SensorMounts, ASecondPublisherOfAPublishedFrameIsToldOnce) {
  SensorMounts mounts(patient(0.8));
  mounts.on_message(Source::kLidar, "velodyne", kStart);
  ASSERT_EQ(mounts.take_unpublished(kStart + 2s).size(), 1u);
  for (int repeated = 0; repeated < 2; ++repeated) mounts.add({kMast, kLidar});
  EXPECT_THAT(mounts.take_warnings(),
              ElementsAre(AllOf(HasSubstr("'velodyne' has two publishers"), HasSubstr("'mast'"))));
}

TEST(SensorMounts, ADefaultWaitsForTheFramesForAMoment) {
  PerceptionConfig config;
  config.frame_patience = 2s;
  SensorMounts mounts(config);
  EXPECT_EQ(mounts.on_message(Source::kLidar, "velodyne", kStart), State::kWaits);
  EXPECT_EQ(mounts.on_message(Source::kImu, "", kStart), State::kDecided) << "no frame could be found";
  mounts.add({kLidar});
  EXPECT_EQ(mounts.on_message(Source::kLidar, "velodyne", kStart + 1s), State::kWaits)
      << "of the chain a part";
  mounts.add({kMast});
  EXPECT_EQ(mounts.on_message(Source::kLidar, "velodyne", kStart + 1100ms), State::kDecided);
  EXPECT_TRUE(mounts.by_frames(Source::kLidar));
}

TEST(SensorMounts, WithoutFramesADefaultIsUsedSilentlyAndFramesThatComeLaterAreSaid) {
  PerceptionConfig config;
  config.frame_patience = 2s;
  SensorMounts mounts(config);
  EXPECT_EQ(mounts.on_message(Source::kLidar, "velodyne", kStart), State::kWaits);
  EXPECT_EQ(mounts.on_message(Source::kLidar, "velodyne", kStart + 2s), State::kDecided);
  EXPECT_EQ(mounts.on_message(Source::kImu, "imu_link", kStart + 2s), State::kDecided) << "all wait together";
  EXPECT_FALSE(mounts.by_frames(Source::kLidar));
  EXPECT_THAT(mounts.take_warnings(), IsEmpty());
  for (int repeated = 0; repeated < 2; ++repeated) mounts.add({kMast, kLidar});
  EXPECT_THAT(mounts.take_warnings(), ElementsAre(HasSubstr("start again")));
}

TEST(SensorMounts, AMissingLinkACycleAndABadQuaternionAreNamed) {
  sensor::SensorFrames broken;
  broken.ids = {"velodyne", "imu_link", "", ""};
  broken.add({{"base_link", "mast", {}, Eigen::Quaterniond(0.0, 0.0, 0.0, 0.0)},
              kLidar,
              {"imu_link", "bracket"},
              {"bracket", "imu_link"}});
  SensorMounts mounts = SensorMounts::of_recording(broken, {});
  EXPECT_THAT(mounts.take_warnings(),
              ElementsAre(AllOf(HasSubstr("from 'base_link' to 'mast'"), HasSubstr("quaternion")),
                          AllOf(HasSubstr("LiDAR"), HasSubstr("'velodyne' leads up to 'mast'")),
                          AllOf(HasSubstr("IMU"), HasSubstr("form a cycle"))));
}

}  // namespace
}  // namespace fleetmap::agent
