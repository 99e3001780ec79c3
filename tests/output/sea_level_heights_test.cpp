#include "fleetmap/output/sea_level_heights.hpp"

#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace fleetmap::output {
namespace {

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

}  // namespace
}  // namespace fleetmap::output
