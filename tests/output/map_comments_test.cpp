#include "fleetmap/output/map_comments.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/scene_store.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::output {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(MapComments, NameTheOriginAndTheTimeOrThatNobodyKnowsThePlace) {
  const fleetmap::testing::TemporaryFolder folder;
  auto store = store::Store::open(folder.path() / "store.db", AgentId::parse("r1").value());
  ASSERT_TRUE(store);
  MapPart part{{}, fleetmap::testing::add_scene(*store), true};
  EXPECT_THAT(
      map_comments(*store, part, fleetmap::testing::kSceneOrigin),
      ElementsAre("Coordinates: metres east, north and up of 49.000000000, 8.400000000 deg, 110.000 m "
                  "above the WGS 84 ellipsoid.",
                  "Newest node: 2026-11-25T18:12:41.000Z"));
  part.georeferenced = false;
  EXPECT_THAT(map_comments(*store, part, {}),
              ElementsAre(HasSubstr("Nobody knows its place"), HasSubstr("Newest node")));
  part.T_map_node.clear();
  EXPECT_THAT(map_comments(*store, part, {}), ElementsAre(HasSubstr("Coordinates")));
}

}  // namespace
}  // namespace fleetmap::output
