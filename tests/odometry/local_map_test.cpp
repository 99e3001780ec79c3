#include "fleetmap/odometry/local_map.hpp"

#include <gtest/gtest.h>

namespace fleetmap::odometry {
namespace {

/// A panel of 2 m x 2 m in the plane x = `x`, as the sensor sees it.
void add_panel(LocalMap& map, double x, const Eigen::Vector3d& sensor) {
  std::vector<Eigen::Vector3d> points;
  for (double y = -1.0; y < 1.0; y += 0.1) {
    for (double z = 0.0; z < 2.0; z += 0.1) points.emplace_back(x, y, z);
  }
  map.add_surfaces(points, sensor);
}

double plane_at(const Surface& surface) { return surface.mean.x(); }

constexpr double kThickness = 0.04;
const Eigen::Vector3d kFront(-5.0, 0.0, 1.0), kBehind(5.0, 0.0, 1.0);
const Eigen::Vector3d kMiddle(0.0, 0.0, 1.0);

TEST(LocalMap, TheOtherSideOfAPanelIsAnotherSurface) {
  LocalMap map({});
  add_panel(map, 0.0, kFront);
  const Surface* front = map.surface_at(kMiddle, kFront);
  ASSERT_NE(front, nullptr);
  EXPECT_LT(front->direction.x(), -0.99f);
  EXPECT_EQ(map.surface_at(kMiddle, kBehind), nullptr) << "nobody was there yet";

  add_panel(map, kThickness, kBehind);
  front = map.surface_at(kMiddle, kFront);
  ASSERT_NE(front, nullptr);
  EXPECT_NEAR(plane_at(*front), 0.0, 1e-4);
  const Surface* back = map.surface_at(kMiddle, kBehind);
  ASSERT_NE(back, nullptr);
  EXPECT_GT(back->direction.x(), 0.99f);
  EXPECT_NEAR(plane_at(*back), kThickness, 1e-4);
}

TEST(LocalMap, GroundThatIsPassedStaysOneSurface) {
  LocalMap map({});
  const auto add_ground = [&](const Eigen::Vector3d& sensor) {
    std::vector<Eigen::Vector3d> points;
    for (double x = -2.0; x < 2.0; x += 0.1) {
      for (double y = -2.0; y < 2.0; y += 0.1) points.emplace_back(x, y, 0.01 * std::sin(7.0 * x));
    }
    map.add_surfaces(points, sensor);
  };
  add_ground({-20.0, 0.0, 0.6});
  const Surface* before = map.surface_at(Eigen::Vector3d::Zero(), {-20.0, 0.0, 0.6});
  ASSERT_NE(before, nullptr);
  const float count = before->count;
  add_ground({20.0, 0.0, 0.6});
  const Surface* after = map.surface_at(Eigen::Vector3d::Zero(), {20.0, 0.0, 0.6});
  ASSERT_NE(after, nullptr);
  EXPECT_FLOAT_EQ(after->count, std::min(2.0f * count, 250.0f));
}

TEST(LocalMap, BothSidesAreForgottenTogether) {
  LocalMap map({});
  add_panel(map, 0.0, kFront);
  ASSERT_NE(map.surface_at(kMiddle, kFront), nullptr);
  add_panel(map, kThickness, kBehind);
  map.prune({100.0, 0.0, 0.0}, 50.0);
  EXPECT_TRUE(map.empty());
  EXPECT_EQ(map.surface_at(kMiddle, kBehind), nullptr);

  add_panel(map, 0.0, kFront);
  ASSERT_NE(map.surface_at(kMiddle, kFront), nullptr);
  add_panel(map, kThickness, kBehind);
  map.prune(kMiddle, 50.0);
  const Surface* back = map.surface_at(kMiddle, kBehind);
  ASSERT_NE(back, nullptr);
  EXPECT_NEAR(plane_at(*back), kThickness, 1e-4);
}

}  // namespace
}  // namespace fleetmap::odometry
