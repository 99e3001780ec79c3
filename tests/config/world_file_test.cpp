#include "fleetmap/config/world_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "fleetmap/sim/mesh_file.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::config {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::filesystem::path example(const std::string& name) {
  return std::filesystem::path(FLEETMAP_SOURCE_DIR) / "config/worlds" / name;
}

class ExampleWorld : public ::testing::TestWithParam<const char*> {};

TEST_P(ExampleWorld, IsAFarmWithFreeLanes) {
  const auto spec = load_world(example(GetParam()));
  ASSERT_TRUE(spec.has_value()) << spec.error().message;
  const auto& farm = std::get<sim::SolarFarmConfig>(*spec);
  if (farm.size_east > 500.0) return;  // seconds to build
  const auto world = sim::build_world(*spec);
  ASSERT_TRUE(world.has_value()) << world.error().message;
  EXPECT_GE((*world)->aisles().size(), 7u);
  EXPECT_GT((*world)->drivable_share(), 0.5);
}

INSTANTIATE_TEST_SUITE_P(Files, ExampleWorld,
                         ::testing::Values("farm_60.yaml", "farm_200.yaml", "farm_1km.yaml",
                                           "rolling_200.yaml"));

TEST(WorldFile, ReadsAFarmsKeys) {
  const testing::TemporaryFolder folder;
  const auto spec = load_world(folder.write("w.yaml",
                                            "kind: solar_farm\nsize: [80, 70]\nseed: 9\ntilt_deg: 20\n"
                                            "row_azimuth_deg: 45\nfence: {enabled: false}\n"
                                            "terrain: {slope_east_deg: 2}\ndrivable: {max_slope_deg: 15}\n"));
  ASSERT_TRUE(spec.has_value()) << spec.error().message;
  const auto& farm = std::get<sim::SolarFarmConfig>(*spec);
  constexpr double kDegree = std::numbers::pi / 180.0;
  EXPECT_EQ(farm.size_east, 80.0);
  EXPECT_EQ(farm.size_north, 70.0);
  EXPECT_EQ(farm.seed, 9u);
  EXPECT_NEAR(farm.tilt_rad, 20.0 * kDegree, 1e-12);
  EXPECT_NEAR(farm.row_azimuth_rad, 45.0 * kDegree, 1e-12);
  EXPECT_FALSE(farm.fence.enabled);
  EXPECT_NEAR(farm.terrain.slope_east_rad, 2.0 * kDegree, 1e-12);
  EXPECT_NEAR(farm.drivable.max_slope_rad, 15.0 * kDegree, 1e-12);
}

TEST(WorldFile, ReportsEveryProblemWithItsLine) {
  const testing::TemporaryFolder folder;
  const auto error = [&](const std::string& content) {
    const auto spec = load_world(folder.write("w.yaml", content));
    return spec ? std::string("no error") : spec.error().message;
  };
  EXPECT_THAT(error("kind: solar_farm\nrow_ptich: 7\nfence:\n  hieght: 2\nmargin: wide\n"),
              AllOf(HasSubstr("w.yaml:2: row_ptich: unknown key; did you mean 'row_pitch'?"),
                    HasSubstr("w.yaml:4: fence.hieght"), HasSubstr("w.yaml:5: margin: expected a number")));
  EXPECT_THAT(error("kind: solar_farm\nseed: 3\nrow_pitch: 4.2\n"), HasSubstr("w.yaml:3: row_pitch"));
  EXPECT_THAT(error("kind: solar_farm\nseed: 3\nsize: [9000, 100]\n"),
              HasSubstr("w.yaml:3: size: size_east must be"));
  EXPECT_THAT(error("kind: solar_farm\nsize: [9, 9]\ntilt_deg: 89\n"), HasSubstr("w.yaml:2: size"));
  EXPECT_THAT(error("kind: solar_farm\nseed: 3\ntilt_deg: 89\n"),
              HasSubstr("w.yaml:3: tilt_deg: tilt must be"));
  EXPECT_THAT(error("kind: solar_farm\nterrain:\n  seed: 1\n  rolling_amplitude: -1\n"),
              AllOf(HasSubstr("w.yaml:3: terrain.seed"), HasSubstr("w.yaml:4: terrain.rolling_amplitude")));
  EXPECT_THAT(error("kind: solar_farm\ndrivable:\n  cell: 0\n"), HasSubstr("w.yaml:3: drivable.cell"));
  EXPECT_THAT(error("kind: moon\n"), HasSubstr("w.yaml:1: kind: expected 'solar_farm' or 'mesh'"));
  EXPECT_THAT(error("kind: mesh\n"), HasSubstr("path must name"));
  EXPECT_THAT(error("kind: mesh\npath: a.obj\naisles: [[[0, 0], [1, 1]],\n  [[0, 0], [1]]]\n"),
              HasSubstr("w.yaml:4: aisles[1]"));
  EXPECT_THAT(error("kind: mesh\npath: a.obj\naisles: [[[0, 0], [0, 0]]]\n"),
              HasSubstr("w.yaml:3: aisles: aisles[0] must be two different points"));
  EXPECT_THAT(load_world(folder.path() / "none.yaml").error().message, HasSubstr("no such file"));
}

TEST(WorldFile, AMeshBesideTheFileBecomesAWorld) {
  const testing::TemporaryFolder folder;
  folder.write("meshes/yard.obj", "v -10 -10 0\nv 10 -10 0\nv 10 10 0\nv -10 10 0\ng ground\nf 1 2 3 4\n");
  const auto file =
      folder.write("w.yaml", "kind: mesh\npath: meshes/yard.obj\naisles:\n  - [[-8, 0], [8, 0]]\n");
  const auto world = make_world(file);
  ASSERT_TRUE(world.has_value()) << world.error().message;
  ASSERT_EQ((*world)->aisles().size(), 1u);
  EXPECT_EQ((*world)->aisles()[0].to.x(), 8.0);
  EXPECT_FALSE((*world)->blocked({0, 0}, 0.4));
}

TEST(WorldFile, ABadMeshIsNamedWithTheFileThatWantsIt) {
  const testing::TemporaryFolder folder;
  folder.write("yard.obj", "v -10 -10 0\nv 10 -10 0\nf 1 2 3\n");
  auto file = folder.write("w.yaml", "kind: mesh\npath: yard.obj\n");
  EXPECT_THAT(make_world(file).error().message,
              AllOf(HasSubstr("w.yaml:2: path: "), HasSubstr("yard.obj:3: '3' names none")));
  folder.write("yard.obj", "v 0 0 0\nv 0 10 0\nv 0 0 10\nf 1 2 3\n");
  EXPECT_THAT(make_world(file).error().message, HasSubstr("cannot be driven"));
  folder.write("yard.obj", "v -10 -10 0\nv 10 -10 0\nv 10 10 0\nf 1 2 3\n");
  file = folder.write("w.yaml", "kind: mesh\npath: yard.obj\naisles: [[[0, 0], [50, 0]]]\n");
  EXPECT_THAT(make_world(file).error().message, HasSubstr("w.yaml:3: aisles: aisles[0] leaves the mesh"));
}

}  // namespace
}  // namespace fleetmap::config
