#include "maps/map_exports.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "fleetmap/cloud/file_io.hpp"
#include "support/file_content.hpp"
#include "support/scene_store.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class MapExports : public ::testing::Test {
 protected:
  /// Two robots with three nodes each.
  StoredMap map(bool located = true) {
    const auto file = folder_.path() / (located ? "located.db" : "lost.db");
    {
      auto store = store::Store::open(file, AgentId::parse("r1").value()).value();
      T_enu_node_ = testing::add_scene(store, located);
    }
    return open_map(file, {testing::kSceneOrigin, 0.2, {}}).value();
  }
  std::string text(const std::string& name) const { return testing::file_text(folder_.path() / name); }
  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }

  testing::TemporaryFolder folder_;
  std::map<NodeId, Pose> T_enu_node_;
};

TEST_F(MapExports, PointsAreThoseThatTheSentenceNames) {
  StoredMap stored = map();
  const auto written = export_points(stored, "located.db", path("map.ply"));
  ASSERT_TRUE(written) << written.error().message;
  const auto cloud = cloud::read_cloud(path("map.ply")).value();
  EXPECT_GT(cloud.size(), 1000u);
  EXPECT_EQ(*written,
            path("map.ply").string() + ": " + std::to_string(cloud.size()) + " points from 6 submaps");
}

TEST_F(MapExports, NodesWithoutSubmapAreNamedByTheirRobot) {
  StoredMap whole = map();
  const auto file = path("lacks.db");
  {
    auto store = store::Store::open(file, AgentId::parse("r1").value()).value();
    for (const graph::Node& node : whole.items.nodes) {
      if (node.id.seq > 0 && node.id.agent.str() == "r2") {
        ASSERT_TRUE(store.put_node(node));
      } else {
        ASSERT_TRUE(store.put_node_with_submap(node, whole.store.submap(node.id).value()));
      }
    }
  }
  StoredMap lacking = open_map(file, {testing::kSceneOrigin, 0.2, {}}).value();
  ::testing::internal::CaptureStderr();
  ASSERT_TRUE(export_points(lacking, "lacks.db", path("lacks.ply")));
  EXPECT_THAT(
      ::testing::internal::GetCapturedStderr(),
      HasSubstr("2 of 6 nodes have no submap in this store (r2: 2 of 3), so the map has holes there"));
}

TEST_F(MapExports, AMapWithoutAPointIsRefusedWithItsCause) {
  const auto file = path("empty.db");
  {
    auto store = store::Store::open(file, AgentId::parse("r1").value()).value();
    ASSERT_TRUE(store.put_node(map().items.nodes.front()));
  }
  StoredMap empty = open_map(file, {testing::kSceneOrigin, 0.2, {}}).value();
  const auto written = export_points(empty, "empty.db", path("map.ply"));
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().message,
              StartsWith("empty.db: the map has no point: no submap of its nodes is held"));
  EXPECT_FALSE(std::filesystem::exists(path("map.ply")));
}

TEST_F(MapExports, TracksAreGpxOrGeoJsonByTheirName) {
  const StoredMap stored = map();
  const auto gpx = export_tracks(stored, "located.db", path("ways.gpx"));
  ASSERT_TRUE(gpx) << gpx.error().message;
  EXPECT_EQ(*gpx, path("ways.gpx").string() + ": 6 nodes");
  EXPECT_THAT(text("ways.gpx"),
              AllOf(HasSubstr("<gpx"), HasSubstr("<trkpt"), HasSubstr("above the WGS 84 ellipsoid")));
  const auto missing = export_tracks(stored, "located.db", path("sea.gpx"), "no-such-geoid");
  EXPECT_THAT(missing.error().message, HasSubstr("no-such-geoid"));
  ASSERT_TRUE(export_tracks(stored, "located.db", path("ways.geojson")));
  EXPECT_THAT(text("ways.geojson"), AllOf(StartsWith("{"), HasSubstr("LineString"), Not(HasSubstr("<gpx"))));
}

TEST_F(MapExports, AMapWithoutGpsHasNoTracksOnEarth) {
  const auto tracks = export_tracks(map(false), "lost.db", path("ways.gpx"));
  ASSERT_FALSE(tracks);
  EXPECT_THAT(tracks.error().message, StartsWith("lost.db: no node of its map has GPS"));
  EXPECT_FALSE(std::filesystem::exists(path("ways.gpx")));
}

TEST_F(MapExports, TheGraphHasAVertexANodeAndAFileOfTheirNames) {
  const auto written = export_graph(map(), path("all.g2o"));
  ASSERT_TRUE(written) << written.error().message;
  EXPECT_THAT(*written, HasSubstr("names of its 6 vertices: " + path("all.g2o.csv").string()));
  const std::string graph = text("all.g2o"), names = text("all.g2o.csv");
  std::size_t vertices = 0;
  for (std::size_t at = graph.find("VERTEX"); at != std::string::npos; at = graph.find("VERTEX", at + 1))
    ++vertices;
  EXPECT_EQ(vertices, 6u);
  EXPECT_THAT(names, HasSubstr("r2"));
}

TEST_F(MapExports, PicturesAreInTheFolderThatIsMade) {
  StoredMap stored = map();
  const auto files = export_pictures(stored, "located.db", path("pictures"));
  ASSERT_TRUE(files) << files.error().message;
  EXPECT_GE(files->size(), 2u);
  for (const std::filesystem::path& file : *files) {
    EXPECT_EQ(file.parent_path(), path("pictures"));
    EXPECT_THAT(testing::file_text(file), StartsWith("\x89PNG"));
  }
}

}  // namespace
}  // namespace fleetmap::apps
