#include "mission/mission_board.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "planning/mission/small_plan.hpp"

namespace fleetmap::planning {
namespace {

using testing::at;
using testing::plan_for;

class MissionBoardTest : public ::testing::Test {
 protected:
  MissionBoardTest() { board_.begin(at(0.0)); }

  std::size_t rows() const { return plan_->mission.rows.size(); }
  /// A row that the plan gives to `robot`.
  std::size_t row_of(std::size_t robot, std::size_t k = 0) const {
    const RowId id = plan_->division.routes[robot].visits.at(k).row;
    return static_cast<std::size_t>(std::ranges::find(plan_->mission.rows, id, &Row::id) -
                                    plan_->mission.rows.begin());
  }
  MissionReport report(std::size_t robot, double stamp) const {
    MissionReport report;
    report.from = plan_->fleet[robot].id;
    report.stamp = at(stamp);
    report.position = plan_->fleet[robot].start.position;
    report.done = report.claimed = report.failed = RowSet(rows());
    return report;
  }

  std::shared_ptr<const FleetPlan> plan_ = plan_for(3);
  MissionBoard board_{plan_, 1};
};

TEST_F(MissionBoardTest, ARobotIsBelievedOfItsOwnRows) {
  MissionReport mine = report(0, 1.0);
  mine.done.set(row_of(0));
  board_.hear(mine, at(1.0));
  EXPECT_TRUE(board_.done().has(row_of(0)));
  // A later report that takes it back is believed, too.
  board_.hear(report(0, 2.0), at(2.0));
  EXPECT_FALSE(board_.done().has(row_of(0)));
}

TEST_F(MissionBoardTest, TheReceiverOfARowGoesBeforeWhoIsUnderWayOnIt) {
  const std::size_t row = row_of(1);
  MissionReport theirs = report(2, 1.0);
  theirs.claimed.set(row);
  board_.hear(theirs, at(1.0));
  EXPECT_FALSE(board_.lost_claim(row, true, at(1.0)));
  const RowId id = plan_->mission.rows[row].id;
  board_.set_row_orders({{at(1.0), plan_->fleet[1].id, plan_->fleet[2].id, {}, id}});
  EXPECT_EQ(board_.receiver(row), 2u);
  EXPECT_TRUE(board_.lost_claim(row, true, at(1.0)));
  EXPECT_FALSE(board_.lost_claim(row, true, at(200.0))) << "the receiver is lost";
  MissionReport none = report(2, 2.0);
  board_.hear(none, at(2.0));
  EXPECT_FALSE(board_.lost_claim(row, false, at(2.0))) << "the receiver has not taken it yet";
  MissionReport first = report(0, 1.0);
  first.claimed.set(row);
  first.current = static_cast<std::uint32_t>(row);
  board_.hear(first, at(2.0));
  board_.set_row_orders({{at(2.0), plan_->fleet[0].id, plan_->fleet[1].id, {}, id}});
  EXPECT_FALSE(board_.lost_claim(row, false, at(2.0))) << "it is ours now";
}

TEST_F(MissionBoardTest, ARowIsTakenFromARobotAsLongAsAnotherCanDriveIt) {
  const std::size_t row = row_of(1);
  board_.set_row_orders({{at(1.0), plan_->fleet[1].id, {}, {}, plan_->mission.rows[row].id},
                         {at(1.0), plan_->fleet[1].id, {}, {}, 4'000'000'000u}});
  EXPECT_TRUE(board_.barred(1, row, at(1.0)));
  EXPECT_FALSE(board_.barred(0, row, at(1.0)));
  EXPECT_FALSE(board_.barred(1, row_of(1, 1), at(1.0)));
  EXPECT_FALSE(board_.receiver(row));
  MissionReport failed = report(0, 1.0);
  failed.failed.set(row);
  board_.hear(failed, at(1.0));
  EXPECT_TRUE(board_.barred(1, row, at(1.0))) << "the third robot can";
  EXPECT_FALSE(board_.barred(1, row, at(70.0))) << "nobody else is left";
}

TEST_F(MissionBoardTest, HearsayCountsOnlyWhereNodesLie) {
  MissionReport hearsay = report(0, 1.0);
  hearsay.done.set(row_of(2));
  board_.hear(hearsay, at(1.0));
  EXPECT_FALSE(board_.done().has(row_of(2)));
  RowSet surveyed(rows());
  surveyed.set(row_of(2));
  board_.set_surveyed(surveyed, at(1.0));
  EXPECT_TRUE(board_.done().has(row_of(2)));
}

TEST_F(MissionBoardTest, TheLastReportOfALostRobotCountsOnlyWhereNodesLie) {
  MissionReport forged = report(0, 1.0);
  forged.done.set(row_of(0, 0));
  forged.done.set(row_of(0, 1));
  board_.hear(forged, at(1.0));
  RowSet surveyed(rows());
  surveyed.set(row_of(0, 1));
  const double lost_after = plan_->config.executive.lost_after;
  board_.set_surveyed(surveyed, at(1.0 + lost_after));
  EXPECT_TRUE(board_.done().has(row_of(0, 0)));
  using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;
  EXPECT_EQ(board_.unconfirmed(), (Pairs{{row_of(0, 0), 0}}));
  board_.set_surveyed(surveyed, at(2.0 + lost_after));
  EXPECT_FALSE(board_.done().has(row_of(0, 0)));
  EXPECT_TRUE(board_.done().has(row_of(0, 1)));
  EXPECT_EQ(board_.unconfirmed(), Pairs{});
  const auto orphans = board_.orphans(at(2.0 + lost_after));
  EXPECT_NE(std::ranges::find(orphans, row_of(0, 0)), orphans.end()) << "somebody else drives it";
}

TEST_F(MissionBoardTest, ReportsThatAreOwnUnknownOldOrBrokenAreIgnored) {
  MissionReport broken = report(0, 1.0);
  broken.position.x() = std::nan("");
  MissionReport own = report(1, 1.0);
  MissionReport unknown = report(0, 1.0);
  unknown.from = testing::name(9);
  for (MissionReport* one : {&broken, &own, &unknown}) {
    for (std::size_t row = 0; row < rows(); ++row) one->done.set(row);
    board_.hear(*one, at(1.0));
  }
  EXPECT_TRUE(board_.done().none());
  board_.hear(report(0, 5.0), at(5.0));
  MissionReport old = report(0, 4.0);
  old.done.set(row_of(0));
  board_.hear(old, at(6.0));
  EXPECT_FALSE(board_.done().has(row_of(0)));
}

TEST_F(MissionBoardTest, ARobotWithoutReportsIsLostAndItsRowsAreOrphans) {
  EXPECT_FALSE(board_.lost(0, at(59.0)));
  EXPECT_TRUE(board_.orphans(at(59.0)).empty());
  EXPECT_TRUE(board_.lost(0, at(61.0)));
  EXPECT_EQ(board_.state(0, at(61.0)), MissionState::kLost);
  const auto orphans = board_.orphans(at(61.0));
  EXPECT_TRUE(std::ranges::binary_search(orphans, row_of(0)));
  EXPECT_TRUE(std::ranges::binary_search(orphans, row_of(2)));
  EXPECT_FALSE(std::ranges::binary_search(orphans, row_of(1)));
  board_.hear(report(0, 61.0), at(61.0));
  EXPECT_FALSE(board_.lost(0, at(120.0)));
}

TEST_F(MissionBoardTest, ClaimUnderWayAndThenTheLowerNameHasPrecedence) {
  const std::size_t row = row_of(1);
  const auto claim = [&](std::size_t robot, bool under_way, double stamp) {
    MissionReport report = this->report(robot, stamp);
    report.claimed.set(row);
    if (under_way) report.current = static_cast<std::uint32_t>(row);
    board_.hear(report, at(stamp));
  };
  claim(2, false, 1.0);  // a higher name
  EXPECT_FALSE(board_.lost_claim(row, false, at(1.0)));
  claim(2, true, 2.0);
  EXPECT_TRUE(board_.lost_claim(row, false, at(2.0)));
  EXPECT_FALSE(board_.lost_claim(row, true, at(2.0)));
  claim(2, false, 3.0);
  claim(0, false, 3.0);  // a lower name
  EXPECT_TRUE(board_.lost_claim(row, false, at(3.0)));
  EXPECT_FALSE(board_.lost_claim(row, true, at(3.0)));
}

TEST_F(MissionBoardTest, ARowThatTwoGaveUpIsAbandoned) {
  const std::size_t row = row_of(0);
  for (const std::size_t robot : {0u, 2u}) {
    EXPECT_FALSE(board_.abandoned(row, at(1.0)));
    MissionReport failed = report(robot, 1.0);
    failed.failed.set(row);
    board_.hear(failed, at(1.0));
  }
  EXPECT_TRUE(board_.abandoned(row, at(1.0)));
  EXPECT_TRUE(board_.finished(row, at(1.0)));
  EXPECT_FALSE(board_.all_finished(at(1.0)));
  // Once both are lost their word does not hold this robot back.
  EXPECT_FALSE(board_.abandoned(row, at(100.0)));
}

TEST_F(MissionBoardTest, OrphansAreDividedAmongThoseWhoAreLeft) {
  board_.hear(report(0, 60.0), at(60.0));
  MissionReport own = report(1, 60.0);
  board_.set_own(own);
  const Stamp now = at(61.0);
  const auto orphans = board_.orphans(now);
  ASSERT_FALSE(orphans.empty());
  const auto takers = board_.takers(orphans, now);
  ASSERT_EQ(takers.size(), orphans.size());
  for (const std::size_t taker : takers) EXPECT_TRUE(taker == 0 || taker == 1) << taker;
  EXPECT_GT(std::ranges::count(takers, 0u), 0);
  EXPECT_GT(std::ranges::count(takers, 1u), 0);
}

}  // namespace
}  // namespace fleetmap::planning
