#include "sim/solar_farm_parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fleetmap::sim {
namespace {

/// One part of a small farm; the rows run east, so that u and v are east and north.
class SolarFarmParts : public ::testing::Test {
 protected:
  SolarFarmParts() {
    config_.size_east = 60.0;
    config_.size_north = 40.0;
    config_.row_azimuth_rad = std::numbers::pi / 2;
    config_.tilt_jitter_rad = config_.height_jitter = 0.0;
    config_.terrain.rolling_amplitude = config_.terrain.rough_amplitude = 0.0;
    config_.trees = 3;
  }
  /// Level but for the slopes of the configuration.
  template <class Add>
  Mesh made(const Add& add) {
    layout_ = lay_out(config_);
    const FarmGround ground{layout_, Terrain(config_.terrain, config_.seed)};
    Mesh mesh;
    MeshBuilder builder(mesh, layout_.direction);
    add(ground, builder);
    EXPECT_EQ(mesh.materials.size(), mesh.triangles.size());
    return mesh;
  }
  Mesh table() {
    return made(
        [&](const FarmGround& ground, MeshBuilder& builder) { add_table(config_, ground, 0, 0, builder); });
  }
  static Mesh only(const Mesh& mesh, Material material) {
    Mesh part;
    part.vertices = mesh.vertices;
    for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
      if (mesh.materials[k] != material) continue;
      part.triangles.push_back(mesh.triangles[k]);
      part.materials.push_back(material);
    }
    return part;
  }
  /// Bounds of the vertices that triangles use.
  static std::pair<Eigen::Vector3f, Eigen::Vector3f> bounds(const Mesh& mesh) {
    Eigen::Vector3f low = Eigen::Vector3f::Constant(1e9f), high = -low;
    for (const auto& triangle : mesh.triangles) {
      for (const std::uint32_t k : triangle) {
        low = low.cwiseMin(mesh.vertices[k]);
        high = high.cwiseMax(mesh.vertices[k]);
      }
    }
    return {low, high};
  }

  SolarFarmConfig config_;
  SolarFarmLayout layout_;
};

TEST_F(SolarFarmParts, TheGroundReachesToTheMarginAndFollowsTheTerrain) {
  config_.terrain.slope_east_rad = 0.1;
  const Mesh ground =
      made([&](const FarmGround& on, MeshBuilder& builder) { add_ground(config_, on, builder); });
  const auto [low, high] = bounds(ground);
  EXPECT_NEAR(high.x(), 45.0f, 1e-4f);
  EXPECT_NEAR(low.y(), -35.0f, 1e-4f);
  EXPECT_EQ(ground.triangles.size(), 2u * 90 * 70) << "cells of a metre";
  const double rise = std::tan(0.1);
  for (const Eigen::Vector3f& v : ground.vertices)
    ASSERT_NEAR(static_cast<double>(v.z()), rise * static_cast<double>(v.x()), 1e-4);
  EXPECT_NEAR(area(ground), 90.0 * 70.0 * std::sqrt(1.0 + rise * rise), 0.1);
  EXPECT_TRUE(std::ranges::all_of(ground.materials, [](Material m) { return m == Material::kGround; }));
}

TEST_F(SolarFarmParts, ATableIsTiltedGlassOnMetalPosts) {
  const Mesh mesh = table();
  const Mesh glass = only(mesh, Material::kGlass), metal = only(mesh, Material::kMetal);
  EXPECT_EQ(glass.triangles.size() + metal.triangles.size(), mesh.triangles.size());
  const auto [low, high] = bounds(glass);
  EXPECT_NEAR(low.z(), 0.8, 1e-3) << "the lower edge";
  EXPECT_NEAR(high.z(), 0.8 + 4.0 * std::sin(0.436) + 0.04 * std::cos(0.436), 1e-3);
  EXPECT_NEAR(high.x() - low.x(), 10.0f, 1e-4f);
  EXPECT_NEAR(0.5f * (low.x() + high.x()), layout_.tables[0], 1e-4);
  EXPECT_NEAR(area(glass), 2 * (10 * 4 + 10 * 0.04 + 4 * 0.04), 1e-2);
  for (const auto& triangle : glass.triangles) {
    for (const std::uint32_t k : triangle)
      EXPECT_EQ(mesh.vertices[k].z() > 1.7f, mesh.vertices[k].y() > layout_.rows[0])
          << "its upper edge is to the left";
  }
  const auto [foot, top] = bounds(metal);
  EXPECT_NEAR(foot.z(), -0.3f, 1e-5f) << "posts reach into the ground";
  EXPECT_LT(top.z(), high.z()) << "and not through the glass";
}

TEST_F(SolarFarmParts, ATableFollowsTheSlopeAlongItsRow) {
  config_.terrain.slope_east_rad = 0.1;
  const Mesh glass = only(table(), Material::kGlass);
  const auto [low, high] = bounds(glass);
  double west = 1e9, east = 1e9;  // the lowest corner at either end
  for (const auto& triangle : glass.triangles) {
    for (const std::uint32_t k : triangle) {
      const Eigen::Vector3d v = glass.vertices[k].cast<double>();
      double& end = v.x() < 0.5 * static_cast<double>(low.x() + high.x()) ? west : east;
      end = std::min(end, v.z() - std::tan(0.1) * v.x());
    }
  }
  EXPECT_NEAR(west, 0.8, 0.02);
  EXPECT_NEAR(east, 0.8, 0.02);
}

TEST_F(SolarFarmParts, TablesDifferByTheirJitterAndNoMore) {
  config_.tilt_jitter_rad = 0.05;
  config_.height_jitter = 0.1;
  float lowest = 1e9f, highest = -1e9f;
  made([&](const FarmGround& ground, MeshBuilder&) {
    for (std::size_t row = 0; row < layout_.rows.size(); ++row) {
      for (std::size_t place = 0; place < layout_.tables.size(); ++place) {
        Mesh mesh;
        MeshBuilder one(mesh, layout_.direction);
        add_table(config_, ground, row, place, one);
        const float z = bounds(only(mesh, Material::kGlass)).first.z();
        lowest = std::min(lowest, z);
        highest = std::max(highest, z);
      }
    }
  });
  EXPECT_GE(lowest, 0.7f - 1e-3f);
  EXPECT_LE(highest, 0.9f + 1e-3f);
  EXPECT_GT(highest - lowest, 0.05f);
}

TEST_F(SolarFarmParts, ACabinHasWallsAndARoofAndNoFloor) {
  const Mesh mesh = made(
      [&](const FarmGround& ground, MeshBuilder& builder) { add_cabin(config_, ground, 1, 0, builder); });
  const auto [low, high] = bounds(mesh);
  EXPECT_NEAR(low.z(), -0.3f, 1e-5f);
  EXPECT_NEAR(high.z(), 2.8f, 1e-5f);
  EXPECT_NEAR(area(mesh), 2 * (6.0 + 2.5) * 3.1 + 6.0 * 2.5, 1e-3);
  const Eigen::Vector2f middle = 0.5f * (low + high).head<2>();
  EXPECT_TRUE(middle.isApprox(Eigen::Vector2d(layout_.tables[0], layout_.rows[1]).cast<float>(), 1e-5f));
}

TEST_F(SolarFarmParts, TheFenceSurroundsTheSiteWithPostsRailsAndWires) {
  config_.fence.height = 2.0;
  config_.fence.post_spacing = 5.0;  // 12 + 8 + 12 + 8 panels
  const auto fence = [&] {
    return made([&](const FarmGround& ground, MeshBuilder& builder) { add_fence(config_, ground, builder); });
  };
  config_.fence.wire_spacing = 0.0;
  const Mesh bare = fence();
  EXPECT_EQ(bare.triangles.size(), 40u * (12 + 2 * 8));
  config_.fence.wire_spacing = 0.5;
  const Mesh wired = fence();
  EXPECT_EQ(wired.triangles.size() - bare.triangles.size(), 40u * 9 * 2) << "nine wires between two posts";
  const auto [low, high] = bounds(wired);
  EXPECT_NEAR(high.x(), 30.0f, 0.05f);
  EXPECT_NEAR(low.y(), -20.0f, 0.05f);
  EXPECT_NEAR(high.z(), 2.0f, 1e-5f);
  for (const Eigen::Vector3f& v : wired.vertices)
    ASSERT_LT(std::min(std::abs(std::abs(v.x()) - 30.0f), std::abs(std::abs(v.y()) - 20.0f)), 0.05f);
}

TEST_F(SolarFarmParts, ATreeIsATrunkUnderACrownOfLeaves) {
  const auto tree = [&](std::size_t number) {
    return made(
        [&](const FarmGround& ground, MeshBuilder& builder) { add_tree(config_, ground, number, builder); });
  };
  const Mesh mesh = tree(1);
  EXPECT_EQ(mesh.triangles.size(), 12u + 350u);
  const Eigen::Vector2f foot = layout_.trees[1].center.cast<float>();
  for (const Eigen::Vector3f& v : mesh.vertices) {
    EXPECT_LT((v.head<2>() - foot).norm(), 2.4f) << "the widest reach of a tree";
    EXPECT_GT(v.z(), -0.301f);
    EXPECT_LT(v.z(), 8.1f);
  }
  EXPECT_NEAR((mesh.vertices[0].head<2>() - foot).norm(), layout_.trees[1].radius, 1e-4);
  EXPECT_EQ(tree(1).vertices, mesh.vertices);
  EXPECT_NE(tree(2).vertices, mesh.vertices);
}

}  // namespace
}  // namespace fleetmap::sim
