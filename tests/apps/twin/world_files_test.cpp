#include "twin/world_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "fleetmap/cloud/file_io.hpp"
#include "fleetmap/config/world_file.hpp"
#include "fleetmap/sim/mesh_file.hpp"
#include "plan/drawn_site.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class WorldFilesTest : public ::testing::Test {
 protected:
  std::string write(const WorldFileOptions& settings) const {
    std::ostringstream out;
    const Status written = write_world(out, *world_, folder_.path() / "world", settings);
    EXPECT_TRUE(written) << written.error().message;
    return out.str();
  }
  std::filesystem::path file(const std::string& name) const { return folder_.path() / "world" / name; }

  std::shared_ptr<const sim::World> world_ =
      config::make_world(FLEETMAP_SOURCE_DIR "/config/worlds/farm_44.yaml").value();
  testing::TemporaryFolder folder_;
};

TEST_F(WorldFilesTest, MeshTruthAndDrawingAreThoseOfTheWorld) {
  const std::string said = write({.density = 5.0});
  const auto ply = sim::read_mesh(file("world.ply")), obj = sim::read_mesh(file("world.obj"));
  ASSERT_TRUE(ply && obj);
  EXPECT_EQ(ply->triangles.size(), world_->mesh().triangles.size());
  EXPECT_EQ(obj->triangles.size(), world_->mesh().triangles.size());
  const auto truth = cloud::read_cloud(file("truth.ply"));
  ASSERT_TRUE(truth);
  const double surface = sim::area(world_->mesh());
  EXPECT_NEAR(static_cast<double>(truth->size()), 5.0 * surface, 0.02 * 5.0 * surface);
  const auto site = read_site(file("site.geojson").string(), std::nullopt);
  ASSERT_TRUE(site) << site.error().message;
  EXPECT_EQ(site->mission.rows.size(), world_->aisles().size());
  EXPECT_THAT(
      said, AllOf(HasSubstr("truth " + std::to_string(truth->size()) + " points, "),
                  HasSubstr("world.ply world.obj truth.ply site.geojson\n"), Not(HasSubstr("--max-points"))));
}

TEST_F(WorldFilesTest, ABoundOfPointsIsKeptAndTold) {
  EXPECT_THAT(write({.density = 5.0, .max_points = 300}), HasSubstr("--max-points allows 300)"));
  EXPECT_LE(cloud::read_cloud(file("truth.ply"))->size(), 300u);
}

TEST_F(WorldFilesTest, AWorldIsDescribedInFourLines) {
  std::ostringstream out;
  describe_world(out, *world_);
  EXPECT_THAT(
      out.str(),
      AllOf(HasSubstr("mesh " + std::to_string(world_->mesh().triangles.size()) + " triangles, "),
            HasSubstr("lanes " + std::to_string(world_->aisles().size()) + ", "), HasSubstr("drivable ")));
}

TEST_F(WorldFilesTest, AFolderThatCannotBeMadeIsNamed) {
  const auto in_the_way = folder_.write("file", "");
  std::ostringstream out;
  const Status written = write_world(out, *world_, in_the_way / "world", {});
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().message, HasSubstr("file"));
}

}  // namespace
}  // namespace fleetmap::apps
