#include "fleetmap/odometry/features.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fleetmap/odometry/deskew.hpp"
#include "support/synthetic_lidar.hpp"

namespace fleetmap::odometry {
namespace {

const testing::PoseAt kStill = [](double) { return Pose::Identity(); };

/// A square room seen from its middle: edges lie in its corners and nowhere else, planes never in them.
TEST(Features, EdgesOfARoomAreItsCorners) {
  testing::SyntheticWorld world;
  world.add_box(make_pose(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.0, 0.0, 5.0)), {5.0, 4.0, 10.0});
  testing::ScanOptions options;
  options.noise = 0.005;
  options.T_base_lidar = Pose::Identity();
  options.T_base_lidar.translation().z() = 5.0;
  LoamConfig config;
  SweepBuilder builder(config, vlp16());
  FeatureExtractor extractor(config);
  const Sweep& sweep = builder.build(make_scan(world, kStill, 0.0, vlp16(), options));
  const Features& features = extractor.extract(sweep);
  auto from_corner = [&](std::uint32_t i) {
    const Eigen::Vector2f p = sweep.points[i].position.head<2>().cwiseAbs();
    return (p - Eigen::Vector2f(5.0f, 4.0f)).norm();
  };
  EXPECT_GE(features.edges.size(), 4u * 16u * 3u / 4u);
  for (const std::uint32_t i : features.edges) EXPECT_LT(from_corner(i), 0.15f);
  EXPECT_GT(features.planes.size(), sweep.points.size() / 2);
  for (const std::uint32_t i : features.planes) EXPECT_GT(from_corner(i), 0.02f);
}

/// Rings and times recovered from the points alone equal the device's own.
TEST(Sweep, RecoversRingsAndTimes) {
  const testing::SyntheticWorld world = testing::yard_world();
  for (const LidarModel& model : {vlp16(), os1_64()}) {
    SweepBuilder with_fields(LoamConfig{}, model), without(LoamConfig{}, model);
    sensor::Scan scan = make_scan(world, kStill, 0.0, model);
    const Sweep& expected = with_fields.build(scan);
    scan.has_ring = scan.has_time = false;
    const Sweep& found = without.build(scan);
    ASSERT_EQ(found.ring_begin, expected.ring_begin) << model.name;
    for (std::size_t i = 0; i < found.points.size(); ++i) {
      ASSERT_NEAR(found.points[i].time, expected.points[i].time, 2e-4) << model.name << " point " << i;
    }
  }
}

/// The series equals the exponential map.
TEST(ConstantTwist, EqualsTheExponentialMap) {
  Vector6d twist;
  twist << 3.0, -0.5, 0.2, 0.3, -0.4, 2.0;
  const ConstantTwist motion(twist);
  const Eigen::Vector3d p(12.0, -7.0, 1.5);
  for (const double s : {-0.1, -0.05, 0.0, 0.02, 0.1}) {
    const Eigen::Vector3d exact = se3_exp(s * twist) * p;
    EXPECT_LT((motion.at_reference(p.cast<float>(), static_cast<float>(s)).cast<double>() - exact).norm(),
              1e-3);
  }
}

}  // namespace
}  // namespace fleetmap::odometry
