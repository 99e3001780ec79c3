#include "maps/store_merge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "apps/driven_days.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::HasSubstr;

class StoreMergeTest : public ::testing::Test {
 protected:
  void SetUp() override {
    days_.drive("a.db", 0, {0.0, 0.0, 0.0});
    days_.drive("b.db", 1, {0.0, 0.0, 0.0});
  }
  MergeOptions into(const std::string& out) const {
    return {{days_.path("a.db"), days_.path("b.db")}, days_.path(out), ""};
  }
  DrivenDays days_;
};

TEST_F(StoreMergeTest, AFolderIsMadeForTheStore) {
  std::ostringstream out;
  const auto merged = merge_files(into("both/days"), out);
  ASSERT_TRUE(merged) << merged.error().error.message;
  EXPECT_THAT(out.str(), HasSubstr(days_.path("both/days/store.db")));
  const auto store = store::Store::open_read_only(days_.path("both/days/store.db"));
  ASSERT_TRUE(store) << store.error().message;
  EXPECT_EQ(store->nodes().size(), 8u);
  EXPECT_TRUE(std::filesystem::exists(days_.path("both/days/store.db.previews")));
}

TEST_F(StoreMergeTest, StoresThatCannotBeMergedFail) {
  std::ostringstream out;
  MergeOptions options = into("both.db");
  options.stores.back() = days_.path("none.db");
  const auto missing = merge_files(options, out);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, kFailed);
  EXPECT_THAT(missing.error().error.message, HasSubstr("none.db"));
  options = into("both.db");
  options.keys = days_.path("no_keys");
  EXPECT_FALSE(merge_files(options, out));
  EXPECT_FALSE(std::filesystem::exists(days_.path("both.db")));
}

}  // namespace
}  // namespace fleetmap::apps
