#include "fleetmap/odometry/lidar_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>

#include "fleetmap/geometry/degree.hpp"

namespace fleetmap::odometry {
namespace {

TEST(LidarModels, HaveTheRingsOfTheirDataSheets) {
  const LidarModel velodyne = vlp16();
  ASSERT_EQ(velodyne.vertical_angles.size(), 16u);
  for (std::size_t ring = 0; ring < 16; ++ring)
    EXPECT_NEAR(velodyne.vertical_angles[ring], (2.0 * static_cast<double>(ring) - 15.0) * kDegree, 1e-12);

  const LidarModel ouster = os1_64();
  ASSERT_EQ(ouster.vertical_angles.size(), 64u);
  EXPECT_NEAR(ouster.vertical_angles.front(), 16.611 * kDegree, 1e-12) << "ring 0 is topmost";
  EXPECT_NEAR(ouster.vertical_angles.back(), -16.611 * kDegree, 1e-12);
  EXPECT_NEAR(ouster.vertical_angles[1] - ouster.vertical_angles[0], -2 * 16.611 / 63 * kDegree, 1e-12);

  // The upper block of lasers lies 1/3 degree apart, the lower one 1/2.
  const LidarModel kitti = hdl64e();
  ASSERT_EQ(kitti.vertical_angles.size(), 64u);
  for (std::size_t ring = 1; ring < 64; ++ring) {
    EXPECT_NEAR(kitti.vertical_angles[ring - 1] - kitti.vertical_angles[ring],
                (ring < 32 ? 1.0 / 3.0 : 0.5) * kDegree, 1e-4)
        << ring;
  }
  EXPECT_EQ(kitti.ring_source, RingSource::kPointOrder);
  EXPECT_EQ(kitti.stamp_phase, 0.5);

  EXPECT_FALSE(generic_lidar().has_rings());
  EXPECT_EQ(generic_lidar().ring_source, RingSource::kNone);
}

TEST(LidarModels, AreFoundByTheirNames) {
  for (const char* name : {"vlp16", "os1-64", "hdl64e", "generic"}) {
    const auto model = lidar_model(name);
    ASSERT_TRUE(model) << name;
    EXPECT_EQ(model->name, name);
    EXPECT_TRUE(model->validate());
  }
}

TEST(LidarModels, NamesThatDoNotExistAreToldThoseThatDo) {
  for (const char* name : {"vlp32", "", "VLP16", "os1"}) {
    const auto model = lidar_model(name);
    ASSERT_FALSE(model) << name;
    EXPECT_EQ(model.error().message,
              "'" + std::string(name) + "' is unknown; expected one of vlp16, os1-64, hdl64e, generic");
  }
}

TEST(LidarModels, TheFieldThatBreaksItsRuleIsNamed) {
  using Change = std::function<void(LidarModel&)>;
  const double nan = std::nan("");
  const std::pair<Change, const char*> broken[] = {
      {[](LidarModel& m) { m.name.clear(); }, "lidar.name"},
      {[](LidarModel& m) { m.vertical_angles.assign(257, 0.0); }, "lidar.vertical_angles: at most 256"},
      {[](LidarModel& m) { m.vertical_angles[3] = 0.5 * std::numbers::pi; }, "lidar.vertical_angles: each"},
      {[=](LidarModel& m) { m.vertical_angles[3] = nan; }, "lidar.vertical_angles: each"},
      {[](LidarModel& m) { m.scan_period = 0.0; }, "lidar.scan_period"},
      {[](LidarModel& m) { m.scan_period = 11.0; }, "lidar.scan_period"},
      {[=](LidarModel& m) { m.scan_period = nan; }, "lidar.scan_period"},
      {[](LidarModel& m) { m.columns = 0; }, "lidar.columns"},
      {[](LidarModel& m) { m.columns = 100'001; }, "lidar.columns"},
      {[=](LidarModel& m) { m.sweep_start_azimuth = nan; }, "lidar.sweep_start_azimuth"},
      {[](LidarModel& m) { m.stamp_phase = -0.1; }, "lidar.stamp_phase"},
      {[](LidarModel& m) { m.stamp_phase = 1.1; }, "lidar.stamp_phase"},
      {[=](LidarModel& m) { m.stamp_phase = nan; }, "lidar.stamp_phase"},
  };
  for (const auto& [change, start] : broken) {
    LidarModel model = vlp16();
    change(model);
    const Status status = model.validate();
    ASSERT_FALSE(status) << start;
    EXPECT_TRUE(status.error().message.starts_with(start)) << status.error().message;
  }
}

TEST(LidarModels, MayBeAtTheEdgeOfTheirRules) {
  LidarModel model = vlp16();
  model.vertical_angles.assign(256, -1.57);
  model.scan_period = 10.0;
  model.columns = 100'000;
  model.stamp_phase = 1.0;
  EXPECT_TRUE(model.validate());
  model.vertical_angles.clear();
  model.scan_period = 0.001;
  model.columns = 1;
  model.sweep_start_azimuth = -3.0;
  EXPECT_TRUE(model.validate());
}

}  // namespace
}  // namespace fleetmap::odometry
