#include "maps/day_changes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "apps/driven_days.hpp"
#include "fleetmap/change/change_files.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class DayChangesTest : public ::testing::Test {
 protected:
  DrivenDays days_;
};

TEST_F(DayChangesTest, TwoDaysOfOnePlaceAreAlignedAndDoNotDiffer) {
  days_.drive("a.db", 0, {0.0, 0.0, 0.0});
  days_.drive("b.db", 1, {0.0, 1.5, 0.5});
  const auto compared = changes_between(days_.path("a.db"), days_.path("b.db"));
  ASSERT_TRUE(compared) << compared.error().message;
  EXPECT_GE(compared->alignments, 2u);
  EXPECT_GT(compared->certainty.median_m, 0.0);
  EXPECT_LT(compared->certainty.median_m, 0.5);
  EXPECT_GT(compared->changes.compared, 1000u);
  EXPECT_LT(compared->changes.misfit_m, 0.2) << "GPS of the second day is 1.6 m off";
  EXPECT_TRUE(compared->changes.changes.empty()) << compared->changes.changes.size() << " changes";
  ASSERT_TRUE(compared->origin);
  EXPECT_TRUE(is_valid(*compared->origin));
}

TEST_F(DayChangesTest, DaysThatCannotBeComparedAreNamedWithTheReason) {
  days_.drive("a.db", 0, {0.0, 0.0, 0.0});
  days_.drive("far.db", 1, {0.0, 700.0, 0.0});
  const auto apart = changes_between(days_.path("a.db"), days_.path("far.db"));
  ASSERT_FALSE(apart);
  EXPECT_THAT(apart.error().message,
              AllOf(HasSubstr("a.db and "), HasSubstr("far.db cannot be aligned: they do not overlap")));
  const auto missing = changes_between(days_.path("a.db"), days_.path("none.db"));
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message, HasSubstr("none.db: no such file"));
}

TEST(DayChangesSummary, HasCountsSharesAndATableIfThereIsAnything) {
  DayChanges compared;
  compared.alignments = 12;
  compared.certainty = {0.03, 0.08, 0.001, 0.002};
  compared.changes.compared = 750;
  compared.changes.unknown = 250;
  compared.changes.min_cells = 6;
  std::ostringstream none;
  print_changes(none, compared);
  EXPECT_THAT(none.str(),
              AllOf(HasSubstr("aligned by 12 alignments"), HasSubstr("certain to 0.03 m and 0.06 deg"),
                    HasSubstr("the worst of them to 0.08 m"), HasSubstr("75 % of the surfaces"),
                    HasSubstr("from 6 cells on"), HasSubstr("\n0 changes: 0 appeared, 0 disappeared\n")));
  change::Change fence;
  fence.kind = change::Kind::disappeared;
  fence.cells = 40;
  compared.changes.changes = {fence};
  std::ostringstream one;
  print_changes(one, compared);
  EXPECT_THAT(one.str(), AllOf(HasSubstr("1 changes: 0 appeared, 1 disappeared\n"),
                               HasSubstr(change::to_table(compared.changes, std::nullopt))));
}

}  // namespace
}  // namespace fleetmap::apps
