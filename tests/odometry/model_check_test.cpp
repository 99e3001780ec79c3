#include "model_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <span>

#include "support/synthetic_lidar.hpp"

namespace fleetmap::odometry {
namespace {

using testing::ScanOptions;

sensor::Scan scan_of(const LidarModel& device, const ScanOptions& options) {
  static const testing::SyntheticWorld world = testing::yard_world();
  return make_scan(
      world,
      [](double t) {
        return make_pose(rotation_from_rpy(0, 0, 0.3 * t), {t, 0, 0});
      },
      0.0, device, options);
}

/// The warnings after thirty such scans that are read with `model`.
std::vector<std::string> news(const sensor::Scan& scan, const LidarModel& model) {
  ModelCheck check(model);
  std::vector<std::string> all;
  for (int k = 0; k < 30; ++k) {
    check.add(scan);
    std::ranges::move(check.take_warnings(), std::back_inserter(all));
  }
  return all;
}

bool says(const std::vector<std::string>& news, const char* what) {
  return news.size() == 1 && news[0].find(what) != std::string::npos;
}

ScanOptions without_rings() {
  ScanOptions options;
  options.has_ring = options.has_time = false;
  return options;
}

TEST(ModelCheck, IsSilentOnScansOfTheirOwnModel) {
  for (const LidarModel& model : {vlp16(), os1_64(), hdl64e(), generic_lidar()}) {
    EXPECT_TRUE(news(scan_of(model, {}), model).empty()) << model.name;
    EXPECT_TRUE(news(scan_of(model, without_rings()), model).empty()) << model.name;
    EXPECT_TRUE(news(scan_of(model, without_rings()), generic_lidar()).empty()) << model.name;
  }
}

TEST(ModelCheck, NamesPointsInMillimetres) {
  sensor::Scan scan = scan_of(vlp16(), {});
  for (sensor::ScanPoint& point : scan.points) point.position *= 1000.0f;
  EXPECT_TRUE(says(news(scan, vlp16()), "in millimetres"));
}

TEST(ModelCheck, NamesAModelThatIsNotThatOfTheScans) {
  EXPECT_TRUE(says(news(scan_of(hdl64e(), without_rings()), vlp16()), "set lidar.model"));
  EXPECT_TRUE(says(news(scan_of(os1_64(), without_rings()), vlp16()), "'vlp16' does not fit"));
  EXPECT_TRUE(says(news(scan_of(vlp16(), without_rings()), hdl64e()), "'hdl64e' does not fit"));
  EXPECT_TRUE(says(news(scan_of(hdl64e(), without_rings()), os1_64()), "'os1-64' does not fit"));
}

TEST(ModelCheck, RingsOfTheScanNeedNoModel) { EXPECT_TRUE(news(scan_of(os1_64(), {}), vlp16()).empty()); }

/// A device whose rings are a tenth of their spacing off the table, each in its own way.
TEST(ModelCheck, ADeviceNeedNotBeExact) {
  LidarModel device = vlp16();
  std::mt19937 random(2);
  std::normal_distribution<double> normal(0.0, 0.2 * std::numbers::pi / 180.0);
  for (double& angle : device.vertical_angles) angle += normal(random);
  EXPECT_TRUE(news(scan_of(device, without_rings()), vlp16()).empty());
}

TEST(ModelCheck, NamesTimesThatRunBackwards) {
  for (const LidarModel& model : {vlp16(), os1_64(), generic_lidar()}) {
    sensor::Scan scan = scan_of(model, {});
    for (sensor::ScanPoint& p : scan.points) p.time = 0.1f - p.time;
    EXPECT_TRUE(says(news(scan, model), "times of the points fall")) << model.name;
  }
}

/// Stored from its end, or by rings: times need not rise in the order of the points.
TEST(ModelCheck, TimesMayComeInAnyOrder) {
  sensor::Scan scan = scan_of(vlp16(), {});
  std::ranges::reverse(scan.points);
  EXPECT_TRUE(news(scan, vlp16()).empty());
  std::ranges::stable_sort(scan.points, {}, &sensor::ScanPoint::ring);
  EXPECT_TRUE(news(scan, vlp16()).empty());
}

/// A driver that turns the points of a LiDAR which hangs upside down: it seems to turn to the left.
TEST(ModelCheck, ALidarMayHangUpsideDown) {
  sensor::Scan scan = scan_of(vlp16(), {});
  for (sensor::ScanPoint& p : scan.points) p.position.y() *= -1.0f;
  EXPECT_TRUE(news(scan, vlp16()).empty());
}

TEST(ModelCheck, AScanWithHardlyAnyPointsIsNotChecked) {
  sensor::Scan scan = scan_of(os1_64(), without_rings());
  scan.points.resize(50);
  EXPECT_TRUE(news(scan, vlp16()).empty());
  EXPECT_TRUE(news({}, vlp16()).empty());
}

}  // namespace
}  // namespace fleetmap::odometry
