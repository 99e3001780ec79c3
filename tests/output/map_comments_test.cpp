#include "fleetmap/output/map_comments.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fleetmap/output/map_files.hpp"
#include "fleetmap/output/sea_level_heights.hpp"
#include "support/scene_store.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::output {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(MapComments, NameTheOriginAndTheTimeOrThatNobodyKnowsThePlace) {
  const fleetmap::testing::TemporaryFolder folder;
  auto store = store::Store::open(folder.path() / "store.db", AgentId::parse("r1").value());
  ASSERT_TRUE(store);
  MapPart part{{}, fleetmap::testing::add_scene(*store), true};
  const store::MergeConfig merge;
  EXPECT_THAT(
      map_comments(*store, part, fleetmap::testing::kSceneOrigin, merge),
      ElementsAre("Coordinates: metres east, north and up of 49.000000000, 8.400000000 deg, 110.000 m "
                  "above the WGS 84 ellipsoid.",
                  StartsWith("CRS: LOCAL_CS[\"East-north-up frame at 49.000000000, 8.400000000 deg"),
                  "Robots: r1, r2", "Newest node: 2026-11-25T18:12:41.000Z",
                  "Content hash: " + to_hex(map_hash(*store, part.T_map_node, merge))));
  part.georeferenced = false;
  EXPECT_THAT(map_comments(*store, part, {}, merge),
              ElementsAre(HasSubstr("Nobody knows its place"), HasSubstr("Earth unknown"),
                          HasSubstr("Robots"), HasSubstr("Newest node"), HasSubstr("Content hash")));
  part.T_map_node.clear();
  EXPECT_THAT(map_comments(*store, part, {}, merge),
              ElementsAre(HasSubstr("Coordinates"), HasSubstr("CRS"), HasSubstr("Content hash")));
}

TEST(MapComments, AreOneShortLineEach) {
  const fleetmap::testing::TemporaryFolder folder;
  auto store = store::Store::open(folder.path() / "store.db", AgentId::parse("r1").value());
  ASSERT_TRUE(store);
  const MapPart part{{}, fleetmap::testing::add_scene(*store), true};
  for (const std::string& line : map_comments(*store, part, fleetmap::testing::kSceneOrigin, {})) {
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    EXPECT_LT(line.size(), 1000u) << "readers of PLY have a limit";
  }
}

TEST(MapComments, HeightsAboveSeaLevelAreNotCalledEllipsoidal) {
  const fleetmap::testing::TemporaryFolder folder;
  auto store = store::Store::open(folder.path() / "store.db", AgentId::parse("r1").value());
  ASSERT_TRUE(store);
  const MapPart part{{}, fleetmap::testing::add_scene(*store), true};
  ASSERT_TRUE(keep_sea_level_heights(*store));
  const auto comments = map_comments(*store, part, fleetmap::testing::kSceneOrigin, {});
  EXPECT_THAT(comments.front(), HasSubstr("110.000 m above mean sea level as GPS gave it"));
  for (const std::string& line : comments) EXPECT_EQ(line.find("ellipsoid"), std::string::npos) << line;
}

}  // namespace
}  // namespace fleetmap::output
