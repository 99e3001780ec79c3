#include "fleetmap/sim/scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "shapes.hpp"

namespace fleetmap::sim {
namespace {

using ::testing::HasSubstr;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

std::shared_ptr<const Scene> scene(const Mesh& mesh) { return Scene::create(mesh).value(); }

/// A wall of metal at x = 5 and one of glass behind it at x = 8.
std::shared_ptr<const Scene> two_walls() {
  Mesh mesh = test_box({5, -10, -10}, {5.1, 10, 10}, Material::kMetal);
  append(mesh, test_box({8, -10, -10}, {8.1, 10, 10}, Material::kGlass));
  return scene(mesh);
}

Hit cast(const Scene& scene, const Ray& ray, float min_range = 0.0f, float max_range = 100.0f) {
  Hit hit;
  scene.cast({&ray, 1}, min_range, max_range, {&hit, 1});
  return hit;
}
Ray from_origin(const Eigen::Vector3f& direction) {
  return {Eigen::Vector3f::Zero(), direction.normalized()};
}

TEST(Scene, ARayHitsTheNearestSurface) {
  const auto walls = two_walls();
  const Hit hit = cast(*walls, from_origin({1, 0, 0}));
  EXPECT_NEAR(hit.distance, 5.0f, 1e-5f);
  EXPECT_NEAR(hit.cos_incidence, 1.0f, 1e-6f);
  EXPECT_EQ(hit.material, Material::kMetal);
  const Hit slanted = cast(*walls, from_origin({1, 0, 1}));
  EXPECT_NEAR(slanted.distance, 5.0f * std::sqrt(2.0f), 1e-4f);
  EXPECT_NEAR(slanted.cos_incidence, std::sqrt(0.5f), 1e-5f);
  EXPECT_LT(cast(*walls, from_origin({-1, 0, 0})).distance, 0.0f);
}

TEST(Scene, OnlyWhatIsWithinReachIsHit) {
  const auto walls = two_walls();
  EXPECT_LT(cast(*walls, from_origin({1, 0, 0}), 0.0f, 4.9f).distance, 0.0f);
  const Hit behind = cast(*walls, from_origin({1, 0, 0}), 6.0f);
  EXPECT_NEAR(behind.distance, 8.0f, 1e-5f) << "what is too near does not hide what is behind";
  EXPECT_EQ(behind.material, Material::kGlass);
  for (const auto& [low, high] : {std::pair(5.0f, 5.0f), std::pair(9.0f, 5.0f), std::pair(-1.0f, 50.0f),
                                  std::pair(kNan, 50.0f), std::pair(0.0f, kNan)})
    EXPECT_LT(cast(*walls, from_origin({1, 0, 0}), low, high).distance, 0.0f) << low << ' ' << high;
}

TEST(Scene, ASurfaceIsSeenFromBothSides) {
  Mesh mesh;
  mesh.vertices = {{5, -10, -10}, {5, 10, -10}, {5, 0, 10}};
  mesh.triangles = {{0, 1, 2}};
  mesh.materials = {Material::kConcrete};
  const auto triangle = scene(mesh);
  EXPECT_NEAR(cast(*triangle, from_origin({1, 0, 0})).distance, 5.0f, 1e-5f);
  const Hit back = cast(*triangle, {{9, 0, 0}, {-1, 0, 0}});
  EXPECT_NEAR(back.distance, 4.0f, 1e-5f);
  EXPECT_NEAR(back.cos_incidence, 1.0f, 1e-6f);
}

TEST(Scene, NumbersOfRaysThatFillNoPacketAndRaysThatAreNoneAreCast) {
  const auto walls = two_walls();
  for (const std::size_t count : {1u, 15u, 16u, 17u, 40u}) {
    std::vector<Ray> rays;
    for (std::size_t k = 0; k < count; ++k)
      rays.push_back(from_origin({1.0f, 0.01f * static_cast<float>(k), 0.0f}));
    rays[count / 2].direction = Eigen::Vector3f::Zero();
    if (count > 2) rays[1].origin.y() = kNan;
    std::vector<Hit> hits(count, Hit{.distance = 77.0f});
    walls->cast(rays, 0.0f, 100.0f, hits);
    for (std::size_t k = 0; k < count; ++k) {
      const bool broken = k == count / 2 || (count > 2 && k == 1);
      const float expected = broken ? -1.0f : 5.0f / rays[k].direction.x();
      EXPECT_NEAR(hits[k].distance, expected, 1e-4f) << k << " of " << count;
    }
  }
  std::vector<Ray> three(3, from_origin({1, 0, 0}));
  std::vector<Hit> two(2);
  walls->cast(three, 0.0f, 100.0f, two);
  EXPECT_NEAR(two[1].distance, 5.0f, 1e-5f) << "as many as there is room for";
}

TEST(Scene, NoRaySlipsThroughBetweenTwoTriangles) {
  const auto ground = scene(test_ground({-10, -10}, {10, 10}, [](double, double) { return 0.0; }));
  int missed = 0;
  for (double x = -9.5; x <= 9.5; x += 0.5) {
    for (double y = -9.5; y <= 9.5; y += 0.5) {  // straight at the vertices, along the sides
      const Hit hit = cast(*ground, {Eigen::Vector3d(x, y, 3).cast<float>(), {0, 0, -1}});
      missed += std::abs(hit.distance - 3.0f) > 1e-5f;
    }
  }
  EXPECT_EQ(missed, 0);
}

TEST(Scene, SaysWhatIsWrongWithAMesh) {
  const auto error = [](const Mesh& mesh) {
    const auto made = Scene::create(mesh);
    return made ? std::string("none") : made.error().message;
  };
  const Mesh box = test_box({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(error(box), "none");
  EXPECT_THAT(error(Mesh{}), HasSubstr("no triangles"));
  Mesh broken = box;
  broken.materials.pop_back();
  EXPECT_EQ(error(broken), "the mesh has 12 triangles but 11 materials; each triangle needs one");
  broken = box;
  broken.vertices[3].z() = kNan;
  EXPECT_THAT(error(broken), HasSubstr("vertex 3 of the mesh is not finite"));
  broken = box;
  broken.triangles[5][1] = 8;
  EXPECT_THAT(error(broken), HasSubstr("triangle 5 of the mesh names vertex 8 of 8"));
}

}  // namespace
}  // namespace fleetmap::sim
