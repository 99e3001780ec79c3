#include "fleetmap/recording/survey.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "bag_samples.hpp"
#include "fleetmap/ros_codec/frame_transforms.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::recording {
namespace {

using namespace std::chrono_literals;
using namespace recording::testing;
using fleetmap::testing::TemporaryFolder;
using ::testing::HasSubstr;

constexpr double kDegree = std::numbers::pi / 180.0;

/// 60 s of a robot that begins to turn by 0.3 rad/s at 30 s; its gyro reports `scale` times that.
std::filesystem::path turning_robot(const std::filesystem::path& folder, double scale) {
  auto bag = BagWriter::create(folder).value();
  put(bag, ros_codec::topics::points(), kStart, ros_codec::encode(scan_at(kStart)));
  for (int k = 0; k < 60 * 50; ++k) {
    const std::int64_t ns = kStart + std::int64_t{k} * 20'000'000;
    const double rate = k < 30 * 50 ? 0.0 : 0.3;
    sensor::Imu imu = imu_at(ns);
    imu.angular_velocity.z() = scale * rate;
    put(bag, ros_codec::topics::imu(), ns, ros_codec::encode(imu));
    put(bag, ros_codec::topics::wheel_odometry(), ns,
        ros_codec::encode(sensor::Wheel{stamp_from_ns(ns), 1.0, rate}));
  }
  return folder;
}

TEST(Survey, TheUnitOfTheGyroIsKnownBeforeTheFirstTurn) {
  const TemporaryFolder folder;
  const auto found = survey(turning_robot(folder.path() / "degrees", 1.0 / kDegree));
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_TRUE(found->gyro_in_degrees);
  EXPECT_THAT(*found->gyro_in_degrees, HasSubstr("times as fast as the wheels"));
  EXPECT_FALSE(survey(turning_robot(folder.path() / "radians", 1.0))->gyro_in_degrees);
}

TEST(Survey, FramesAreThoseOfTheMessages) {
  const TemporaryFolder folder;
  {
    auto bag = BagWriter::create(folder.path() / "bag").value();
    put(bag, ros_codec::topics::points(), kStart, ros_codec::encode(scan_at(kStart), "velodyne"));
    put(bag, ros_codec::topics::imu(), kStart + 1, ros_codec::encode(imu_at(kStart), "imu_link"));
    bus::Topic namespaced = ros_codec::topics::tf_static(), moving = namespaced;
    namespaced.name = "rt/r1/tf_static";
    moving.name = "rt/tf";
    put(bag, moving, kStart + 2, ros_codec::encode({{"odom", "base_link"}}));
    put(bag, namespaced, kStart + 3,
        ros_codec::encode({{"base_link", "velodyne", {0.0, 0.0, 0.8}},
                           {"base_link", "camera", {}, Eigen::Quaterniond(0.0, 0.0, 0.0, 0.0)}}));
  }
  const auto found = survey(folder.path() / "bag");
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_THAT(found->frames.ids, ::testing::ElementsAre("velodyne", "imu_link", "", ""));
  const auto T = found->frames.tree.find("base_link", "velodyne");
  ASSERT_TRUE(T) << T.error().message;
  EXPECT_EQ(T->translation(), Eigen::Vector3d(0.0, 0.0, 0.8));
  EXPECT_THAT(found->frames.refused, ::testing::ElementsAre(HasSubstr("'camera'")));
  EXPECT_FALSE(found->frames.tree.find("odom", "base_link")) << "of /tf, which moves";
}

TEST(Survey, WhatIsNoRecordingIsAnErrorAndKittiHasNoClock) {
  const TemporaryFolder folder;
  EXPECT_FALSE(survey(folder.path() / "none"));
  const float point[4] = {1, 2, 3, 0};
  folder.write("drive/0.bin", {reinterpret_cast<const char*>(point), sizeof(point)});
  const auto found = survey(folder.path() / "drive");
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->clock.usable);
  EXPECT_EQ(found->clock.shift, 0ns);
}

}  // namespace
}  // namespace fleetmap::recording
