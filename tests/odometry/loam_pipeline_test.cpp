#include "loam_pipeline.hpp"

#include <gtest/gtest.h>

#include "support/synthetic_lidar.hpp"

namespace fleetmap::odometry {
namespace {

using testing::ScanOptions;
using testing::SyntheticDrive;

LoamConfig yard_config() {
  LoamConfig config;
  config.T_base_lidar = ScanOptions{}.T_base_lidar;
  return config;
}

/// A drive through the yard that is under way when the first scan is taken.
class LoamPipelineTest : public ::testing::Test {
 protected:
  explicit LoamPipelineTest() : pipeline_(yard_config(), vlp16()) {}

  Pose pose(double seconds) const { return motion_.at(kBegin + seconds); }
  sensor::Scan scan_at(double seconds, const Pose* standing = nullptr) const {
    return make_scan(
        world_, [&](double t) { return standing != nullptr ? *standing : pose(t); }, seconds, vlp16());
  }

  static constexpr double kBegin = 4.0;  // s
  const testing::SyntheticWorld world_ = testing::yard_world();
  const SyntheticDrive motion_{{{2.0, 2.0, 0}, {30, 2.0, 0.5}}, 2.0, 2.0, 0.0};
  LoamPipeline pipeline_;
};

TEST_F(LoamPipelineTest, AWrongSettingFailsEveryScanWithItsName) {
  LoamConfig wrong = yard_config();
  wrong.max_range = -1.0;
  LoamPipeline pipeline(wrong, vlp16());
  for (int k = 0; k < 2; ++k) {
    const auto update = pipeline.add_scan(scan_at(0.1 * k));
    ASSERT_FALSE(update);
    EXPECT_NE(update.error().message.find("max_range"), std::string::npos) << update.error().message;
  }
  EXPECT_EQ(pipeline.counters().scans, 0u);
}

/// The first scan is not compensated, since its motion is unknown. Once the second one tells it, the first
/// one enters the map again, or its smear of 20 cm would bend all that follow.
TEST_F(LoamPipelineTest, TheFirstScanOfARobotUnderWayIsCompensatedByTheSecond) {
  for (int k = 0; k < 10; ++k) {
    const auto update = pipeline_.add_scan(scan_at(0.1 * k));
    ASSERT_TRUE(update) << update.error().message;
    EXPECT_FALSE(update->lost) << k;
    if (k == 0) continue;
    const Pose error = (pose(0.0).inverse() * pose(0.1 * k)).inverse() * update->T_odom_base;
    EXPECT_LT(error.translation().norm(), 0.03) << k;
    EXPECT_LT(so3_log(error.linear()).norm(), 0.011) << k;
  }
}

/// Each point is where it was relative to the robot at the scan's stamp, though it was measured up to 0.1 s
/// and 20 cm later.
TEST_F(LoamPipelineTest, PointsAreThoseOfTheStamp) {
  LoamConfig config = yard_config();
  config.max_range = config.map_radius = 120.0;
  config.min_range = 0.1;
  LoamPipeline pipeline(config, vlp16());
  for (int k = 0; k < 5; ++k) ASSERT_TRUE(pipeline.add_scan(scan_at(0.1 * k)));
  sensor::Scan scan = scan_at(0.5);
  for (std::size_t k = 0; k < scan.points.size(); ++k) scan.points[k].intensity = static_cast<float>(k);
  const auto update = pipeline.add_scan(scan);
  ASSERT_TRUE(update) << update.error().message;
  ASSERT_EQ(update->points.points.size(), scan.points.size());
  const Pose T_base_lidar = yard_config().T_base_lidar;
  double squares = 0.0, squares_as_measured = 0.0;
  for (std::size_t k = 0; k < scan.points.size(); ++k) {  // in another order; the intensity identifies each
    const auto& point = scan.points.at(static_cast<std::size_t>(update->points.intensities[k]));
    const Eigen::Vector3d measured = T_base_lidar * point.position.cast<double>();
    const Eigen::Vector3d right = pose(0.5).inverse() * (pose(0.5 + point.time) * measured);
    squares += (update->points.points[k].cast<double>() - right).squaredNorm();
    squares_as_measured += (measured - right).squaredNorm();
  }
  const double count = static_cast<double>(scan.points.size());
  EXPECT_LT(std::sqrt(squares / count), 0.02);
  EXPECT_GT(std::sqrt(squares_as_measured / count), 0.1) << "the drive is too slow to show it";
}

/// Otherwise a robot that waits for an hour would fill its map with noise.
TEST_F(LoamPipelineTest, ARobotThatStandsAddsNextToNothingToItsMap) {
  const Pose here = pose(0.0);
  for (int k = 0; k < 3; ++k) ASSERT_TRUE(pipeline_.add_scan(scan_at(0.1 * k, &here)));
  const LocalMapSize before = pipeline_.map_size();
  for (int k = 3; k < 20; ++k) ASSERT_TRUE(pipeline_.add_scan(scan_at(0.1 * k, &here)));
  EXPECT_LT(static_cast<double>(pipeline_.map_size().windows), 1.01 * static_cast<double>(before.windows));
  EXPECT_EQ(pipeline_.counters().lost, 0u);
  LoamPipeline driving(yard_config(), vlp16());
  for (int k = 0; k < 20; ++k) ASSERT_TRUE(driving.add_scan(scan_at(0.1 * k)));
  EXPECT_GT(driving.map_size().windows, 1.2 * static_cast<double>(before.windows));
}

}  // namespace
}  // namespace fleetmap::odometry
