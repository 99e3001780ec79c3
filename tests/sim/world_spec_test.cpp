#include "fleetmap/sim/world_spec.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fleetmap/sim/mesh_file.hpp"
#include "shapes.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::sim {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class WorldSpecTest : public ::testing::Test {
 protected:
  /// 20 x 10 m of level ground.
  MeshWorld mesh_world() {
    MeshWorld world;
    world.path = folder_.path() / "site.ply";
    EXPECT_TRUE(write_ply(world.path, test_ground({-10, -5}, {10, 5}, [](double, double) { return 2.0; })));
    world.aisles = {Aisle{{-8, 0}, {8, 0}}};
    return world;
  }
  static std::string error(const MeshWorld& spec) {
    const auto world = build_world(spec);
    return world ? "none" : world.error().message;
  }
  testing::TemporaryFolder folder_;
};

TEST_F(WorldSpecTest, AMeshBecomesAWorldWithItsAisles) {
  const auto world = build_world(mesh_world(), 17);
  ASSERT_TRUE(world) << world.error().message;
  EXPECT_NEAR((*world)->ground_height({1, 1}), 2.0, 1e-6);
  ASSERT_EQ((*world)->aisles().size(), 1u);
  EXPECT_EQ((*world)->aisles()[0].to, Eigen::Vector2d(8, 0));
}

TEST_F(WorldSpecTest, TheMeshsFileAndTheFieldAreNamed) {
  MeshWorld spec = mesh_world();
  spec.path.clear();
  EXPECT_EQ(error(spec), "path must name a .obj or .ply mesh");
  spec.path = folder_.path() / "none.ply";
  EXPECT_THAT(error(spec), AllOf(HasSubstr("none.ply"), HasSubstr("no such file")));
  spec = mesh_world();
  ASSERT_TRUE(write_ply(spec.path, test_ground({0, 0}, {5, 5}, [](double x, double) { return 3.0 * x; })));
  EXPECT_THAT(error(spec), AllOf(StartsWith(spec.path.string() + ": "), HasSubstr("cannot be driven")));
  spec = mesh_world();
  spec.drivable.cell = 0.0;
  EXPECT_THAT(error(spec), StartsWith("drivable: cell must be"));
}

TEST_F(WorldSpecTest, AislesAreLinesWithinTheMesh) {
  MeshWorld spec = mesh_world();
  spec.aisles.push_back(Aisle{{-8, 2}, {10.5, 2}});
  EXPECT_EQ(error(spec), "aisles[1] leaves the mesh " + spec.path.string() +
                             ", which spans east -10.0 to 10.0 m, north -5.0 to 5.0 m; move its ends");
  for (const Eigen::Vector2d& to : {Eigen::Vector2d(-8, 2.05), Eigen::Vector2d(std::nan(""), 2)}) {
    spec.aisles[1].to = to;
    EXPECT_EQ(error(spec), "aisles[1] must be two different points");
  }
}

TEST_F(WorldSpecTest, ASeedReplacesThatOfASolarFarm) {
  SolarFarmConfig farm;
  farm.size_east = 50.0;
  farm.size_north = 50.0;
  farm.fence.enabled = false;
  farm.seed = 3;
  const auto own = build_world(farm), same = build_world(farm, 3), other = build_world(farm, 4);
  ASSERT_TRUE(own && same && other);
  EXPECT_EQ((*own)->mesh().vertices, (*same)->mesh().vertices);
  EXPECT_NE((*own)->mesh().vertices, (*other)->mesh().vertices);
  farm.row_pitch = -1.0;
  EXPECT_THAT(build_world(farm).error().message, HasSubstr("row_pitch"));
}

}  // namespace
}  // namespace fleetmap::sim
