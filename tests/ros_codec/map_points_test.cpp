#include "fleetmap/ros_codec/map_points.hpp"

#include <gtest/gtest.h>

#include "fleetmap/bus/cdr.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "sensor_msgs.h"

namespace fleetmap::ros_codec {
namespace {

/// Read as a driver's cloud, whose reader refuses fields and sizes that contradict each other.
TEST(MapPoints, IsACloudThatTheReaderOfCloudsTakes) {
  MapPoints map{stamp_from_ns(42), "map", {}};
  for (int k = 1; k <= 3; ++k)
    map.points.push_back({Eigen::Vector3f(static_cast<float>(k), -2.0f, 0.5f), 10.0f * static_cast<float>(k),
                          static_cast<std::uint16_t>(k)});
  const auto back = decode_scan(encode(map));
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->scan.stamp, stamp_from_ns(42));
  ASSERT_EQ(back->scan.points.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(back->scan.points[k].position, map.points[k].p);
    EXPECT_EQ(back->scan.points[k].intensity, map.points[k].intensity);
  }
  const auto cloud = bus::from_cdr<sensor_msgs::msg::dds_::PointCloud2_>(encode(map), "test").value();
  EXPECT_EQ(cloud.point_step() % sizeof(float), 0u) << "readers map floats in place";
  EXPECT_EQ(cloud.data()[2 * cloud.point_step() + cloud.fields()[4].offset()], 3) << "the robot";
}

}  // namespace
}  // namespace fleetmap::ros_codec
