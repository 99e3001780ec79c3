#include "mission/row_attempts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fleetmap::planning {
namespace {

using ::testing::HasSubstr;
using Outcome = RowAttempts::Outcome;

constexpr double kLength = 100.0;
constexpr int kMaxAttempts = 2;

Outcome blocked(RowAttempts& attempts, bool reversed, double driven) {
  attempts.begin(1, reversed);
  return attempts.blocked(1, driven, kLength, {12.0, 34.0}, kMaxAttempts);
}

TEST(RowAttempts, ABlockedRowIsTriedFromTheOtherEndAndThenGivenUp) {
  RowAttempts attempts(3);
  EXPECT_TRUE(attempts.next_reversed(1, true));  // as planned
  EXPECT_EQ(blocked(attempts, true, 30.0), Outcome::kRetry);
  EXPECT_TRUE(attempts.tried(1));
  EXPECT_FALSE(attempts.next_reversed(1, true));
  EXPECT_TRUE(attempts.abandoned().none());
  EXPECT_EQ(blocked(attempts, false, 40.0), Outcome::kAbandoned);
  EXPECT_TRUE(attempts.abandoned().has(1));
  EXPECT_EQ(attempts.abandoned().count(), 1u);
  EXPECT_EQ(attempts.times_abandoned(), 1u);
  EXPECT_THAT(attempts.reason(1),
              HasSubstr("blocked near (12.0, 34.0) m; of 100 m it was driven 40 m from its "
                        "first and 30 m from its last waypoint"));
  EXPECT_EQ(attempts.reason(0), "");
}

TEST(RowAttempts, ARowWhoseRestWasSeenFromBothEndsIsDriven) {
  RowAttempts attempts(3);
  EXPECT_EQ(blocked(attempts, false, 50.0), Outcome::kRetry);
  EXPECT_EQ(blocked(attempts, true, 43.0), Outcome::kDriven);  // 7 m are left
  EXPECT_TRUE(attempts.abandoned().none());
}

TEST(RowAttempts, ARowThatIsDrivenToNineTenthsIsDriven) {
  RowAttempts attempts(3);
  EXPECT_EQ(blocked(attempts, false, 91.0), Outcome::kDriven);
  RowAttempts others(3);
  EXPECT_EQ(blocked(others, false, 89.0), Outcome::kRetry);
}

TEST(RowAttempts, TheFarthestAttemptFromAnEndCounts) {
  RowAttempts attempts(3);
  attempts.begin(1, false);
  EXPECT_EQ(attempts.blocked(1, 60.0, kLength, {0, 0}, 10), Outcome::kRetry);
  attempts.begin(1, false);
  EXPECT_EQ(attempts.blocked(1, -5.0, kLength, {0, 0}, 10), Outcome::kRetry);  // it did not even get there
  attempts.begin(1, true);
  EXPECT_EQ(attempts.blocked(1, 33.0, kLength, {0, 0}, 10), Outcome::kDriven);
}

TEST(RowAttempts, ARowWithoutAWayIsGivenUpAtTheFourthTime) {
  RowAttempts attempts(3);
  for (int k = 0; k < 3; ++k) EXPECT_FALSE(attempts.unreachable(2, "no way"));
  EXPECT_TRUE(attempts.unreachable(2, "no way"));
  EXPECT_TRUE(attempts.abandoned().has(2));
  EXPECT_EQ(attempts.reason(2), "no way");
}

TEST(RowAttempts, ARobotThatCanMoveAgainTriesAnew) {
  RowAttempts attempts(3);
  blocked(attempts, false, 10.0);
  blocked(attempts, true, 10.0);
  attempts.reset();
  EXPECT_TRUE(attempts.abandoned().none());
  EXPECT_EQ(attempts.reason(1), "");
  EXPECT_FALSE(attempts.tried(1));
  EXPECT_EQ(attempts.times_abandoned(), 1u);  // it counts what happened
  EXPECT_EQ(blocked(attempts, false, 10.0), Outcome::kRetry);
}

}  // namespace
}  // namespace fleetmap::planning
