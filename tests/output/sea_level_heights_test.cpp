#include "fleetmap/output/sea_level_heights.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/scene_store.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::output {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(SeaLevelHeights, AreRememberedByTheStore) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "store.db";
  {
    auto store = store::Store::open(file, AgentId::parse("r1").value()).value();
    EXPECT_FALSE(has_sea_level_heights(store));
    ASSERT_TRUE(keep_sea_level_heights(store));
    ASSERT_TRUE(keep_sea_level_heights(store));
  }
  EXPECT_TRUE(has_sea_level_heights(store::Store::open_read_only(file).value()));
}

TEST(SeaLevelHeights, AreUnknownOfPeersUnlessTheirStoresWereMerged) {
  const testing::TemporaryFolder folder;
  auto store = store::Store::open(folder.path() / "store.db", AgentId::parse("r1").value()).value();
  testing::add_scene(store);
  EXPECT_THAT(unknown_heights(store), ElementsAre(AgentId::parse("r2").value()));
  const std::set<AgentId> both{AgentId::parse("r1").value(), AgentId::parse("r2").value()};
  ASSERT_TRUE(keep_known_heights(store, both));
  EXPECT_EQ(known_heights(store), both);
  EXPECT_THAT(unknown_heights(store), IsEmpty());
}

TEST(SeaLevelHeights, OfNodesWithoutGpsThereAreNone) {
  const testing::TemporaryFolder folder;
  auto store = store::Store::open(folder.path() / "store.db", AgentId::parse("r1").value()).value();
  testing::add_scene(store, false);
  EXPECT_THAT(unknown_heights(store), IsEmpty());
}

}  // namespace
}  // namespace fleetmap::output
