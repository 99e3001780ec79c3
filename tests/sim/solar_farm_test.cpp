#include "fleetmap/sim/solar_farm.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "fleetmap/sim/terrain.hpp"

namespace fleetmap::sim {
namespace {

using ::testing::HasSubstr;

SolarFarmConfig small_farm() {
  SolarFarmConfig config;
  config.size_east = 70.0;
  config.size_north = 60.0;
  config.road_every = 3;
  config.missing_tables = 0.1;
  config.cabins = 1;
  config.trees = 8;
  config.seed = 11;
  return config;
}

std::shared_ptr<const World> made(const SolarFarmConfig& config) {
  auto world = make_solar_farm(config);
  EXPECT_TRUE(world.has_value()) << (world ? "" : world.error().message);
  return world.value_or(nullptr);
}

bool inside(const Footprint& polygon, const Eigen::Vector2d& p, double slack) {
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Eigen::Vector2d side = polygon[(k + 1) % polygon.size()] - polygon[k];
    const Eigen::Vector2d to = p - polygon[k];
    if (side.x() * to.y() - side.y() * to.x() < -slack * side.norm()) return false;
  }
  return true;
}

bool way_is_free(const World& world, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const int steps = 1 + static_cast<int>((to - from).norm() / 0.1);
  for (int k = 0; k <= steps; ++k) {
    if (world.blocked(from + (to - from) * (static_cast<double>(k) / steps), 0.35)) return false;
  }
  return true;
}

class SolarFarm : public ::testing::TestWithParam<double> {};

TEST_P(SolarFarm, LanesAndTheHeadlandBetweenThemAreFree) {
  SolarFarmConfig config = small_farm();
  config.row_azimuth_rad = GetParam();
  const auto world = made(config);
  ASSERT_TRUE(world);
  ASSERT_GE(world->aisles().size(), 6u);
  for (std::size_t k = 0; k < world->aisles().size(); ++k) {
    const Aisle& aisle = world->aisles()[k];
    EXPECT_TRUE(way_is_free(*world, aisle.from, aisle.to)) << k;
    if (k == 0) continue;
    EXPECT_TRUE(way_is_free(*world, world->aisles()[k - 1].from, aisle.from)) << k;
    EXPECT_TRUE(way_is_free(*world, world->aisles()[k - 1].to, aisle.to)) << k;
  }
}

TEST_P(SolarFarm, TheDrawingShowsWhatIsInTheWayWhereAllWasBuiltAsDrawn) {
  SolarFarmConfig config = small_farm();
  config.missing_tables = 0.0;
  config.row_azimuth_rad = GetParam();
  const auto world = made(config);
  ASSERT_TRUE(world);
  // Within the fence; cells in the way reach half their diagonal beyond what stands in them.
  const Eigen::Vector2d along(std::sin(GetParam()), std::cos(GetParam())), across(-along.y(), along.x());
  const double slack = config.drivable.cell * 1.5;
  int blocked = 0, shown_and_free = 0, shown = 0;
  for (double u = -34.0; u < 34.0; u += 0.3) {
    for (double v = -29.0; v < 29.0; v += 0.3) {
      const Eigen::Vector2d p = u * along + v * across;
      const auto covers = [&](double by) {
        return std::ranges::any_of(world->drawing().keep_out,
                                   [&](const Footprint& f) { return inside(f, p, by); });
      };
      if (world->blocked(p, 0.0)) {
        ++blocked;
        EXPECT_TRUE(covers(slack)) << p.transpose();
      }
      if (!covers(0.0)) continue;
      ++shown;
      if (!world->blocked(p, 3.0)) ++shown_and_free;
    }
  }
  EXPECT_GT(blocked, 500);
  EXPECT_GT(shown, 3000);
  EXPECT_EQ(shown_and_free, 0);
}

TEST_P(SolarFarm, TheDrawingIsOfTheFarmAsPlannedNotAsItStands) {
  SolarFarmConfig config = small_farm();
  config.row_azimuth_rad = GetParam();
  config.missing_tables = 0.0;
  const auto whole = made(config);
  config.missing_tables = 0.3;
  config.trees = 40;
  config.trees_inside = 30;
  const auto ragged = made(config);
  ASSERT_TRUE(whole && ragged);
  EXPECT_EQ(whole->drawing().keep_out, ragged->drawing().keep_out);
  EXPECT_EQ(whole->drawing().boundary, ragged->drawing().boundary);
  EXPECT_LT(whole->drawing().keep_out.size(), 40u) << "rows of tables, not tables, posts or trees";
  ASSERT_EQ(whole->drawing().boundary.size(), 4u);
  EXPECT_NEAR((whole->drawing().boundary[1] - whole->drawing().boundary[0]).norm(), 70.0, 1e-9)
      << "the fence";
}

INSTANTIATE_TEST_SUITE_P(Azimuths, SolarFarm, ::testing::Values(1.57079633, 1.2, 0.0));

TEST(SolarFarmWorld, AislesGoFromSouthToNorthAndStayInTheSite) {
  const auto world = made(small_farm());
  ASSERT_TRUE(world);
  double last = -1e9;
  for (const Aisle& aisle : world->aisles()) {
    EXPECT_DOUBLE_EQ(aisle.from.y(), aisle.to.y());
    EXPECT_LT(aisle.from.x(), aisle.to.x());
    EXPECT_GT(aisle.from.y(), last);
    last = aisle.from.y();
    for (const Eigen::Vector2d& end : {aisle.from, aisle.to}) {
      EXPECT_LT(std::abs(end.x()), 35.0);
      EXPECT_LT(std::abs(end.y()), 30.0);
    }
  }
}

TEST(SolarFarmWorld, GroundAgreesWithTheTerrain) {
  SolarFarmConfig config = small_farm();
  config.terrain.rough_amplitude = 0.0;  // finer than the ground's triangles
  config.terrain.rolling_amplitude = 1.0;
  const auto world = made(config);
  ASSERT_TRUE(world);
  const Terrain terrain(config.terrain, config.seed);
  for (double x = -40.0; x < 40.0; x += 1.7) {
    for (double y = -35.0; y < 35.0; y += 1.3) {
      EXPECT_NEAR(world->ground_height({x, y}), terrain.height(x, y), 0.03) << x << ' ' << y;
    }
  }
}

bool same_bytes(const Mesh& a, const Mesh& b) {
  return a.vertices.size() == b.vertices.size() && a.triangles == b.triangles && a.materials == b.materials &&
         std::memcmp(a.vertices.data(), b.vertices.data(), a.vertices.size() * sizeof(Eigen::Vector3f)) == 0;
}

TEST(SolarFarmWorld, SameSeedSameBytesAnotherSeedOthers) {
  SolarFarmConfig config = small_farm();
  const auto a = made(config), b = made(config);
  config.seed = 12;
  const auto c = made(config);
  ASSERT_TRUE(a && b && c);
  EXPECT_TRUE(same_bytes(a->mesh(), b->mesh()));
  EXPECT_FALSE(same_bytes(a->mesh(), c->mesh()));
}

TEST(SolarFarmWorld, TablesAreGlassAboveTheirPosts) {
  SolarFarmConfig config = small_farm();
  config.missing_tables = 0.0;
  config.cabins = 0;
  config.fence.enabled = false;
  config.trees = 0;
  const auto world = made(config);
  ASSERT_TRUE(world);
  double glass = 0.0;
  const Mesh& mesh = world->mesh();
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    if (mesh.materials[k] != Material::kGlass) continue;
    const auto& [a, b, c] = mesh.triangles[k];
    glass +=
        0.5 * static_cast<double>(
                  (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm());
    for (const std::uint32_t index : mesh.triangles[k]) {
      const Eigen::Vector3d p = mesh.vertices[index].cast<double>();
      const double above = p.z() - world->ground_height(p.head<2>());
      EXPECT_GT(above, 0.55);
      EXPECT_LT(above, 2.9);
    }
  }
  // 6 rows of 4 tables, of 2 x 10 x 4 m and their edges.
  EXPECT_NEAR(glass, 6 * 4 * (80.0 + 2 * 14 * config.table_thickness), 0.1);
}

TEST(SolarFarmWorld, SaysWhatDoesNotFit) {
  const auto error = [](auto&& change) {
    SolarFarmConfig config = small_farm();
    change(config);
    const auto world = make_solar_farm(config);
    return world ? std::string("no error") : world.error().message;
  };
  EXPECT_THAT(error([](auto& c) { c.size_east = 2000.0; }), HasSubstr("size_east must be"));
  EXPECT_THAT(error([](auto& c) { c.row_pitch = std::nan(""); }), HasSubstr("row_pitch must be"));
  EXPECT_THAT(error([](auto& c) { c.row_pitch = 4.5; }), HasSubstr("a robot needs"));
  EXPECT_THAT(error([](auto& c) { c.headland = 28.0; }), HasSubstr("fewer than two rows"));
  EXPECT_THAT(error([](auto& c) { c.headland = 3.0; }), HasSubstr("headland must be"));
  EXPECT_THAT(error([](auto& c) { c.margin = 1.0; }), HasSubstr("margin must be"));
  EXPECT_THAT(error([](auto& c) { c.terrain_cell = 0.05; }), HasSubstr("terrain_cell must be"));
  EXPECT_THAT(error([](auto& c) { c.terrain.rolling_amplitude = 50.0; }), HasSubstr("terrain: "));
  EXPECT_THAT(error([](auto& c) { c.drivable.cell = 0.0; }), HasSubstr("drivable: cell"));
  EXPECT_THAT(error([](auto& c) {
                c.terrain.rolling_amplitude = 2.5;
                c.drivable.max_slope_rad = 0.05;
              }),
              HasSubstr("cannot be driven"));
}

}  // namespace
}  // namespace fleetmap::sim
