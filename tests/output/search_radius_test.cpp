#include "search_radius.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "support/temporary_folder.hpp"

namespace fleetmap::output {
namespace {

TEST(SearchRadius, IsReadAsItWasStored) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "store.db";
  {
    auto store = store::Store::open(file, AgentId::parse("r1").value()).value();
    EXPECT_FALSE(search_radius(store)) << "of an older program";
    ASSERT_TRUE(keep_search_radius(store, 12.5));
  }
  EXPECT_EQ(search_radius(store::Store::open_read_only(file).value()), 12.5);
}

TEST(SearchRadius, ThatIsImpossibleIsNone) {
  const testing::TemporaryFolder folder;
  auto store = store::Store::open(folder.path() / "store.db", AgentId::parse("r1").value()).value();
  for (const double radius_m : {std::numeric_limits<double>::quiet_NaN(), 0.0, -3.0}) {
    ASSERT_TRUE(keep_search_radius(store, radius_m));
    EXPECT_FALSE(search_radius(store)) << radius_m;
  }
}

}  // namespace
}  // namespace fleetmap::output
