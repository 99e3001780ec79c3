#include "sweep.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "fleetmap/geometry/degree.hpp"

namespace fleetmap::odometry {
namespace {

using ::testing::ElementsAre;
using ::testing::FloatNear;
using ::testing::Pointwise;

/// A return at 10 m; its intensity is its number.
void add(sensor::Scan& scan, double azimuth_deg, double elevation_deg, std::uint16_t ring = 0,
         float time = 0) {
  const double azimuth = azimuth_deg * kDegree, elevation = elevation_deg * kDegree;
  const Eigen::Vector3d p(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                          std::sin(elevation));
  scan.points.push_back({(10.0 * p).cast<float>(), static_cast<float>(scan.points.size()), time, ring});
}

std::vector<float> intensities_of(std::span<const SweepPoint> points) {
  std::vector<float> numbers;
  for (const SweepPoint& p : points) numbers.push_back(p.intensity);
  return numbers;
}

std::vector<float> times_of(const Sweep& sweep) {
  std::vector<float> times;
  for (const SweepPoint& p : sweep.points) times.push_back(p.time);
  return times;
}

TEST(SweepBuilder, PointsAreInBaseLinkAndTheirRangeIsFromTheLidar) {
  LoamConfig config;
  config.T_base_lidar = make_pose(rotation_from_rpy(0, 0, 0.5 * std::numbers::pi), Eigen::Vector3d(1, 2, 3));
  sensor::Scan scan;
  scan.stamp = stamp_from_ns(77);
  scan.points.push_back({{3.0f, 0.0f, 4.0f}, 9.0f});
  SweepBuilder builder(config, generic_lidar());
  const Sweep& sweep = builder.build(scan);
  EXPECT_EQ(sweep.stamp, scan.stamp);
  ASSERT_EQ(sweep.points.size(), 1u);
  EXPECT_LT((sweep.points[0].position - Eigen::Vector3f(1, 5, 7)).norm(), 1e-5f);
  EXPECT_FLOAT_EQ(sweep.points[0].range, 5.0f);
  EXPECT_EQ(sweep.points[0].intensity, 9.0f);
}

TEST(SweepBuilder, BadReturnsAreDroppedAndCounted) {
  LoamConfig config;
  config.min_range = 1.0;
  config.max_range = 20.0;
  sensor::Scan scan;
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  for (const Eigen::Vector3f& p :
       {Eigen::Vector3f(nan, 1, 1), Eigen::Vector3f(1, -infinity, 1), Eigen::Vector3f(0, 0, 0),
        Eigen::Vector3f(0.99f, 0, 0), Eigen::Vector3f(1, 0, 0), Eigen::Vector3f(20, 0, 0),
        Eigen::Vector3f(0, 20.1f, 0)})
    scan.points.push_back({p, static_cast<float>(scan.points.size())});
  SweepBuilder builder(config, generic_lidar());
  EXPECT_THAT(intensities_of(builder.build(scan).points), ElementsAre(4, 5));
  EXPECT_EQ(builder.defects().non_finite, 2u);
  EXPECT_EQ(builder.defects().out_of_range, 3u);
  EXPECT_TRUE(builder.build(sensor::Scan{}).points.empty());
  EXPECT_EQ(builder.defects().out_of_range, 0u) << "defects are those of the last scan";
}

TEST(SweepBuilder, SortsByRingAndKeepsTheOrderWithinOne) {
  sensor::Scan scan;
  scan.has_ring = true;
  for (int k = 0; k < 16; ++k) {
    add(scan, 20.0 * k, 10.0, 2);
    if (k % 4 == 3) add(scan, 20.0 * k, -10.0, 0);
  }
  scan.points[3].ring = 300;  // no device has so many
  SweepBuilder builder(LoamConfig{}, generic_lidar());
  const Sweep& sweep = builder.build(scan);
  EXPECT_FALSE(builder.defects().rings_ignored);
  ASSERT_EQ(sweep.rings(), 3u);
  EXPECT_THAT(intensities_of(sweep.ring(0)), ElementsAre(4, 9, 14, 19));
  EXPECT_TRUE(sweep.ring(1).empty());
  EXPECT_THAT(intensities_of(sweep.ring(2)),
              ElementsAre(0, 1, 2, 5, 6, 7, 8, 10, 11, 12, 13, 15, 16, 17, 18));
  EXPECT_EQ(sweep.ring_begin.back(), 19u);
  EXPECT_EQ(sweep.points.back().intensity, 3.0f) << "points of no ring come last";
}

TEST(SweepBuilder, RingsThatContradictTheElevationsGiveWayToTheTable) {
  sensor::Scan scan;
  scan.has_ring = true;
  for (int k = 0; k < 64; ++k) add(scan, 5.0 * k, k % 8 < 4 ? 7.2 : -14.9, static_cast<std::uint16_t>(k % 3));
  add(scan, 0.0, 40.0);
  SweepBuilder builder(LoamConfig{}, vlp16());
  const Sweep& sweep = builder.build(scan);
  EXPECT_TRUE(builder.defects().rings_ignored);
  ASSERT_EQ(sweep.rings(), 12u);
  EXPECT_EQ(sweep.ring(11).size(), 32u) << "7 degrees is that of ring 11";
  EXPECT_EQ(sweep.ring(0).size(), 32u);
  EXPECT_EQ(sweep.points.size() - sweep.ring_begin.back(), 1u) << "40 degrees is that of none";
}

/// The points of a KITTI file: ring by ring, each from the front to the left. Elevations tell nothing here.
TEST(SweepBuilder, RingsAreFoundByTheOrderOfThePoints) {
  LidarModel model = generic_lidar();
  model.vertical_angles = {0.3, 0.1, -0.1, -0.3};
  model.ring_source = RingSource::kPointOrder;
  sensor::Scan scan;
  for (int ring = 0; ring < 4; ++ring) {
    for (int k = 0; k < 8; ++k) add(scan, 5.0 + 45.0 * k, 60.0);
  }
  SweepBuilder builder(LoamConfig{}, model);
  const Sweep& sweep = builder.build(scan);
  ASSERT_EQ(sweep.rings(), 4u);
  EXPECT_THAT(sweep.ring_begin, ElementsAre(0, 8, 16, 24, 32));
  EXPECT_THAT(intensities_of(sweep.ring(2)), ElementsAre(16, 17, 18, 19, 20, 21, 22, 23));
}

TEST(SweepBuilder, TimesCountFromTheMiddleOfTheSweep) {
  sensor::Scan scan;
  scan.has_time = true;
  for (const float time : {0.02f, 0.06f, 0.12f}) add(scan, 0.0, 0.0, 0, time);
  SweepBuilder builder(LoamConfig{}, generic_lidar());
  const Sweep& sweep = builder.build(scan);
  EXPECT_TRUE(sweep.has_times);
  EXPECT_NEAR(sweep.reference_offset, 0.07, 1e-7);
  EXPECT_THAT(times_of(sweep),
              ElementsAre(FloatNear(-0.05f, 1e-7f), FloatNear(-0.01f, 1e-7f), FloatNear(0.05f, 1e-7f)));
}

TEST(SweepBuilder, FewBadTimesCostTheirPointsAndManyTheField) {
  const auto scan_with = [](int bad) {
    sensor::Scan scan;
    scan.has_time = true;
    for (int k = 0; k < 20; ++k) {
      const float wrong = k % 2 == 0 ? 0.201f : std::numeric_limits<float>::quiet_NaN();
      add(scan, 0.0, 0.0, 0, k < bad ? wrong : -0.199f);
    }
    return scan;
  };
  SweepBuilder builder(LoamConfig{}, generic_lidar());
  EXPECT_EQ(builder.build(scan_with(2)).points.size(), 18u) << "two periods either way may be right";
  EXPECT_EQ(builder.defects().bad_times, 2u);
  EXPECT_FALSE(builder.defects().times_ignored);
  const Sweep& sweep = builder.build(scan_with(3));
  EXPECT_TRUE(builder.defects().times_ignored);
  EXPECT_EQ(sweep.points.size(), 20u);
  EXPECT_FALSE(sweep.has_times) << "without rings there are no others";
  EXPECT_EQ(sweep.points[7].time, 0.0f);
  EXPECT_EQ(sweep.reference_offset, 0.0);
}

TEST(SweepBuilder, WithoutTimesTheAzimuthTellsThem) {
  LidarModel model = vlp16();
  model.clockwise = false;
  model.sweep_start_azimuth = 90.0 * kDegree;
  model.scan_period = 0.2;
  sensor::Scan scan;
  for (const double azimuth : {100.0, 190.0, 280.0, 10.0}) add(scan, azimuth, 1.0);
  // Turns of 10, 100, 190 and 280 degrees, counted from their middle.
  const std::vector<float> left{-0.075f, -0.025f, 0.025f, 0.075f};
  SweepBuilder to_the_left(LoamConfig{}, model);
  const Sweep& sweep = to_the_left.build(scan);
  EXPECT_TRUE(sweep.has_times);
  EXPECT_THAT(times_of(sweep), Pointwise(FloatNear(1e-4f), left));
  EXPECT_NEAR(sweep.reference_offset, 0.2 * 145.0 / 360.0, 1e-4);

  model.stamp_phase = 0.5;
  SweepBuilder from_the_middle(LoamConfig{}, model);
  EXPECT_NEAR(from_the_middle.build(scan).reference_offset, 0.2 * (145.0 / 360.0 - 0.5), 1e-4);

  model.clockwise = true;  // turns of 350, 260, 170 and 80 degrees
  const std::vector<float> right{0.075f, 0.025f, -0.025f, -0.075f};
  SweepBuilder to_the_right(LoamConfig{}, model);
  EXPECT_THAT(times_of(to_the_right.build(scan)), Pointwise(FloatNear(1e-4f), right));
}

}  // namespace
}  // namespace fleetmap::odometry
