#include "maps/stored_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/driven_days.hpp"
#include "store/items.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(StoredMap, FilesThatAreNoStoreAreRefusedWithTheRemedy) {
  const testing::TemporaryFolder folder;
  EXPECT_THAT(check_store(folder.path()).error().message, HasSubstr("is a folder; give the store.db"));
  EXPECT_THAT(check_store(folder.path() / "none.db").error().message, HasSubstr("none.db: no such file"));
  folder.write("map.ply", "ply\nformat ascii 1.0\n");
  EXPECT_THAT(check_store(folder.path() / "map.ply").error().message, HasSubstr("map.ply: is no store"));
  folder.write("empty.db", "");
  EXPECT_FALSE(check_store(folder.path() / "empty.db"));
  EXPECT_FALSE(open_map(folder.path() / "map.ply", {}));
}

TEST(StoredMap, NamesThatAreNoneAreRefused) {
  EXPECT_THAT(robots_named({"r1", "r20"}).value(), ElementsAre(testing::agent("r1"), testing::agent("r20")));
  EXPECT_FALSE(robots_named({"r1", "two words"}));
}

class StoredDay : public ::testing::Test {
 protected:
  StoredDay() { days_.drive("a.db", 0, {0.0, 0.0, 0.0}); }
  DrivenDays days_;
};

TEST_F(StoredDay, IsPlacedAsWholeAndEachNodeIsShown) {
  const auto map = open_map(days_.path("a.db"), {});
  ASSERT_TRUE(map) << map.error().message;
  EXPECT_EQ(map->items.nodes.size(), map->store.nodes().size());
  EXPECT_EQ(map->placement.T_enu_node.size(), map->store.nodes().size());
  const auto shown = shown_poses(*map);
  EXPECT_EQ(shown.size(), map->store.nodes().size());
}

TEST_F(StoredDay, TheOriginAndTheVoxelsAreThoseAskedFor) {
  const auto map = open_map(days_.path("a.db"), {});
  ASSERT_TRUE(map);
  const GeoPoint north{map->recipe.origin.latitude + 1e-5, map->recipe.origin.longitude,
                       map->recipe.origin.altitude};
  const auto moved = open_map(days_.path("a.db"), {north, 0.25, {}});
  ASSERT_TRUE(moved) << moved.error().message;
  EXPECT_EQ(moved->recipe.merge.voxel_m, 0.25);
  const auto& [id, before] = *map->placement.T_enu_node.begin();
  const double southward = before.translation().y() - moved->placement.T_enu_node.at(id).translation().y();
  EXPECT_NEAR(southward, 63.7, 0.5) << "1e-5 rad of latitude";
  EXPECT_THAT(open_map(days_.path("a.db"), {GeoPoint{9.0, 0.0, 0.0}, {}, {}}).error().message,
              HasSubstr("--origin is not on Earth"));
}

TEST_F(StoredDay, ARobotOfWhichNothingIsHeldCannotBeLeftOut) {
  const auto map = open_map(days_.path("a.db"), {{}, {}, {testing::agent("r9")}});
  ASSERT_FALSE(map);
  EXPECT_THAT(map.error().message, HasSubstr("r9"));
}

}  // namespace
}  // namespace fleetmap::apps
