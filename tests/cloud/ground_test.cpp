#include "fleetmap/cloud/ground.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace fleetmap::cloud {
namespace {

constexpr float kDegree = 3.14159265f / 180.0f;

/// Points with what they are, so that a split can be scored.
class Scene {
 public:
  explicit Scene(unsigned seed) : random_(seed) {}

  /// `area_m` x `area_m` of terrain around the origin, where `hidden` says no.
  void add_terrain(float area_m, const std::function<float(float, float)>& height,
                   std::size_t count = 40'000) {
    for (std::size_t i = 0; i < count; ++i) {
      const float x = area_m * (unit() - 0.5f), y = area_m * (unit() - 0.5f);
      add({x, y, height(x, y)}, true);
    }
  }
  /// A wall of 8 m above `height`, along a line in the plane.
  void add_wall(const Eigen::Vector2f& from, const Eigen::Vector2f& to,
                const std::function<float(float, float)>& height) {
    for (int i = 0; i < 6000; ++i) {
      const Eigen::Vector2f xy = from + unit() * (to - from);
      add({xy.x(), xy.y(), height(xy.x(), xy.y()) + 8.0f * unit()}, false);
    }
  }
  void add_plate(const Eigen::Vector3f& corner, const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                 int count) {
    for (int i = 0; i < count; ++i) add(corner + unit() * a + unit() * b, false);
  }
  void rotate(const Eigen::Matrix3f& R) {
    for (auto& p : cloud_.points) p = R * p;
  }
  void add(const Eigen::Vector3f& p, bool ground) {
    cloud_.points.emplace_back(p +
                               0.02f * Eigen::Vector3f(gauss_(random_), gauss_(random_), gauss_(random_)));
    is_ground_.push_back(ground);
  }

  struct Score {
    double ground_found = 0.0;  ///< share of ground points called ground
    double objects_kept = 0.0;  ///< share of object points (all, feet included) kept
  };
  Score score(const GroundConfig& config) const {
    const GroundSplit split = split_ground(cloud_, config);
    EXPECT_EQ(split.kept.size() + split.ground.size(), cloud_.size());
    double ground = 0, objects = 0, found = 0, kept = 0;
    for (const bool is : is_ground_) (is ? ground : objects) += 1;
    for (const std::size_t i : split.ground) found += is_ground_[i] ? 1 : 0;
    for (const std::size_t i : split.kept) kept += is_ground_[i] ? 0 : 1;
    return {ground > 0 ? found / ground : 1.0, objects > 0 ? kept / objects : 1.0};
  }
  const PointCloud& cloud() const { return cloud_; }

 private:
  float unit() { return uniform_(random_); }
  std::mt19937 random_;
  std::uniform_real_distribution<float> uniform_{0.0f, 1.0f};
  std::normal_distribution<float> gauss_;
  PointCloud cloud_;
  std::vector<bool> is_ground_;
};

/// Rows of tilted panels, lower edge at 1 m and upper edge at 2 m above `height`, two posts each.
void add_panel_rows(Scene& scene, const std::function<float(float, float)>& height) {
  for (int row = 0; row < 4; ++row) {
    for (int table = 0; table < 5; ++table) {
      const float x = -22.0f + 9.0f * static_cast<float>(table);
      const float y = -18.0f + 10.0f * static_cast<float>(row);
      const float z = height(x + 4.0f, y + 1.5f);
      const float tilt = height(x + 8.0f, y) - height(x, y);
      scene.add_plate({x, y, z + 1.0f - 0.5f * tilt}, {8, 0, tilt}, {0, 3, 1}, 2500);
      for (const float post : {1.0f, 7.0f}) {
        const float foot = height(x + post, y + 1.5f);
        scene.add_plate({x + post, y + 1.5f, foot + 0.3f}, {0.08f, 0.08f, 0}, {0, 0, 1.0f}, 80);
      }
    }
  }
}

float flat(float, float) { return 0.0f; }
float rolling(float x, float y) { return 1.2f * std::sin(0.13f * x) + 0.8f * std::cos(0.17f * y); }
float slope15(float x, float) { return std::tan(15.0f * kDegree) * x; }

class OnTerrain : public ::testing::TestWithParam<float (*)(float, float)> {};
INSTANTIATE_TEST_SUITE_P(Ground, OnTerrain, ::testing::Values(flat, rolling, slope15));

TEST_P(OnTerrain, GroundGoesWhileWallsStay) {
  Scene scene(1);
  scene.add_terrain(60.0f, GetParam());
  scene.add_wall({-20, 8}, {20, 8}, GetParam());
  scene.add_wall({-22, -15}, {-20, 5}, GetParam());
  const auto score = scene.score({});
  EXPECT_GT(score.ground_found, 0.97);
  EXPECT_GT(score.objects_kept, 0.93);  // the feet of the walls are within the thickness
}

TEST_P(OnTerrain, PanelsOnPostsStay) {
  Scene scene(2);
  scene.add_terrain(60.0f, GetParam());
  add_panel_rows(scene, GetParam());
  const auto score = scene.score({});
  EXPECT_GT(score.ground_found, 0.97);
  EXPECT_GT(score.objects_kept, 0.97);
}

TEST_P(OnTerrain, PanelsStayWhereTheyHideTheGroundBelow) {
  Scene all(3);
  all.add_terrain(60.0f, GetParam());
  Scene scene(4);
  for (const auto& p : all.cloud().points) {
    const float in_row = std::fmod(p.y() + 18.0f + 100.0f, 10.0f);
    if (in_row > 3.0f || p.y() < -18.0f || p.y() > 15.0f) scene.add(p, true);
  }
  add_panel_rows(scene, GetParam());
  const auto score = scene.score({});
  EXPECT_GT(score.ground_found, 0.95);
  EXPECT_GT(score.objects_kept, 0.95);
}

/// Law: the split does not depend on the frame as long as `up` turns with the cloud.
TEST(Ground, FollowsUpOfATiltedSensor) {
  Scene scene(5);
  scene.add_terrain(60.0f, rolling);
  add_panel_rows(scene, rolling);
  const Eigen::Matrix3f R = rotation_from_rpy(0.3, -0.25, 1.0).cast<float>();
  scene.rotate(R);
  GroundConfig config;
  config.up = R * Eigen::Vector3f::UnitZ();
  const auto score = scene.score(config);
  EXPECT_GT(score.ground_found, 0.97);
  EXPECT_GT(score.objects_kept, 0.97);
}

TEST(Ground, ARoofIsNoGround) {
  Scene scene(6);
  scene.add_terrain(60.0f, flat, 20'000);
  scene.add_plate({-15, -10, 3}, {12, 0, 0}, {0, 10, 0}, 20'000);
  EXPECT_GT(scene.score({}).objects_kept, 0.99);
}

TEST(Ground, StrayPointsBelowDoNotHideIt) {
  Scene scene(7);
  scene.add_terrain(60.0f, flat);
  for (int i = 0; i < 60; ++i)
    scene.add({-25.0f + 0.8f * static_cast<float>(i), 0.3f * static_cast<float>(i), -3}, false);
  EXPECT_GT(scene.score({}).ground_found, 0.97);
}

TEST(Ground, CloudsWithoutGroundLoseNextToNothing) {
  Scene walls(8);
  walls.add_wall({-20, 8}, {20, 8}, flat);
  walls.add_wall({-20, -9}, {15, -6}, slope15);
  EXPECT_GT(walls.score({}).objects_kept, 0.999);

  Scene crowns(9);
  std::mt19937 random(9);
  std::normal_distribution<float> gauss;
  for (int tree = 0; tree < 12; ++tree) {
    const Eigen::Vector3f middle(5.0f * static_cast<float>(tree % 4), 6.0f * static_cast<float>(tree / 4),
                                 4.0f);
    for (int i = 0; i < 1500; ++i) {
      crowns.add(middle + 1.2f * Eigen::Vector3f(gauss(random), gauss(random), gauss(random)), false);
    }
  }
  EXPECT_GT(crowns.score({}).objects_kept, 0.95);
}

TEST(Ground, EmptyAndNonFiniteCloudsAreHarmless) {
  EXPECT_TRUE(split_ground(PointCloud{}, {}).ground.empty());
  PointCloud cloud;
  cloud.points = {{std::numeric_limits<float>::quiet_NaN(), 0, 0}, {1, 1, 1}, {1e30f, 0, 0}};
  const auto split = split_ground(cloud, {});
  EXPECT_EQ(split.refused, 1u);
  EXPECT_EQ(split.kept, (std::vector<std::size_t>{1, 2}));
}

TEST(Ground, ConfigNamesTheBrokenRule) {
  GroundConfig config;
  config.up.setZero();
  EXPECT_NE(config.validate().error().message.find("up"), std::string::npos);
  EXPECT_TRUE(GroundConfig{}.validate());
}

}  // namespace
}  // namespace fleetmap::cloud
