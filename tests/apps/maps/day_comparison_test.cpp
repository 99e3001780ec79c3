#include "maps/day_comparison.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "apps/driven_days.hpp"
#include "support/file_content.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::HasSubstr;

TEST(DayComparison, PrintsAndWritesTheChanges) {
  const DrivenDays days;
  days.drive("a.db", 0, {0.0, 0.0, 0.0});
  days.drive("b.db", 1, {0.0, 0.0, 0.0});
  std::ostringstream out;
  const DiffOptions options{days.path("a.db"), days.path("b.db"), days.path("c.geojson"), days.path("c.ply")};
  const auto compared = compare_days(options, out);
  ASSERT_TRUE(compared) << compared.error().error.message;
  EXPECT_EQ(*compared, kDone);
  EXPECT_THAT(out.str(), HasSubstr("\n0 changes: "));
  EXPECT_TRUE(std::filesystem::exists(options.geojson));
  EXPECT_THAT(testing::file_text(options.ply), HasSubstr("comment CRS: "));
}

TEST(DayComparison, ADayThatIsMissingFails) {
  const DrivenDays days;
  days.drive("a.db", 0, {0.0, 0.0, 0.0});
  std::ostringstream out;
  const auto compared = compare_days({days.path("a.db"), days.path("none.db"), "", ""}, out);
  ASSERT_FALSE(compared);
  EXPECT_EQ(compared.error().code, kFailed);
  EXPECT_THAT(compared.error().error.message, HasSubstr("none.db: no such file"));
}

}  // namespace
}  // namespace fleetmap::apps
