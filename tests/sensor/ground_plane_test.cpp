#include "fleetmap/sensor/ground_plane.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "fleetmap/geometry/degree.hpp"

namespace fleetmap::sensor {
namespace {

constexpr double kHeight = 0.6;  // m, of the LiDAR above base_link, which lies on the ground

using Surface = std::function<double(double x, double y)>;

/// Returns of 16 lasers between -15 and 15 deg from ground of some height (m) and from what stands on it: a
/// wall at x = 6 m, and a panel that leans by 30 deg from 0.8 m up, behind y = 3 m.
Scan scan_of(const Surface& ground, double noise, bool panel = true) {
  std::mt19937 random(3);
  std::normal_distribution<double> error(0.0, noise);
  Scan scan;
  for (int laser = 0; laser < 16; ++laser) {
    for (int k = 0; k < 360; ++k) {
      const double elevation = (-15.0 + 2.0 * laser) * kDegree, azimuth = k * kDegree;
      const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth),
                                std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      for (double range = 1.0; range < 40.0; range += 0.02) {
        const Eigen::Vector3d p = range * ray + Eigen::Vector3d(0.0, 0.0, kHeight);
        const bool on_panel = panel && p.y() > 3.0 && std::abs(p.z() - 0.8 - 0.58 * (p.y() - 3.0)) < 0.02;
        if (p.z() > ground(p.x(), p.y()) && p.x() < 6.0 && !on_panel) continue;
        scan.points.push_back({((range + error(random)) * ray).cast<float>()});
        break;
      }
    }
  }
  return scan;
}

const Pose kMount = make_pose(Eigen::Matrix3d::Identity().eval(), Eigen::Vector3d(0.0, 0.0, kHeight));

double degrees_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(a.dot(b), -1.0, 1.0)) / kDegree;
}

TEST(GroundPlane, IsFoundBesideWallsAndPanels) {
  const auto normal = ground_normal(scan_of([](double, double) { return 0.0; }, 0.02), kMount);
  ASSERT_TRUE(normal);
  EXPECT_LT(degrees_between(*normal, Eigen::Vector3d::UnitZ()), 0.5);
}

TEST(GroundPlane, OfRollingGroundIsNearlyLevel) {
  const auto normal = ground_normal(
      scan_of([](double x, double y) { return 0.1 * std::sin(x) * std::cos(0.7 * y); }, 0.02), kMount);
  ASSERT_TRUE(normal);
  EXPECT_LT(degrees_between(*normal, Eigen::Vector3d::UnitZ()), 3.0);
}

TEST(GroundPlane, LeansAsAWrongMountMakesItLean) {
  const Scan scan = scan_of([](double, double) { return 0.0; }, 0.02);
  for (const double pitch : {-30.0, -6.0, 12.0, 30.0}) {
    const Pose wrong =
        make_pose(rotation_from_rpy(0.0, pitch * kDegree, 0.0), Eigen::Vector3d(0.0, 0.0, kHeight));
    const auto normal = ground_normal(scan, wrong);
    ASSERT_TRUE(normal) << pitch;
    EXPECT_LT(degrees_between(*normal, wrong.linear() * Eigen::Vector3d::UnitZ()), 0.5) << pitch;
  }
}

TEST(GroundPlane, IsNotInventedWhereNoneIsSeen) {
  EXPECT_FALSE(ground_normal(Scan{}, kMount));
  EXPECT_FALSE(ground_normal(scan_of([](double, double) { return -50.0; }, 0.02, false), kMount))
      << "walls alone";
  std::mt19937 random(1);
  std::uniform_real_distribution<float> anywhere(-10.0f, 10.0f);
  Scan foliage;
  for (int k = 0; k < 3000; ++k)
    foliage.points.push_back({{anywhere(random), anywhere(random), anywhere(random)}});
  EXPECT_FALSE(ground_normal(foliage, kMount));
}

}  // namespace
}  // namespace fleetmap::sensor
