#include "mission/row_claims.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "planning/mission/small_plan.hpp"

namespace fleetmap::planning {
namespace {

using testing::at;
using testing::plan_for;

/// Claims and board of the first robot; the others report by hand.
struct Robot {
  explicit Robot(int robots) : plan(plan_for(robots)), board(plan, 0), claims(plan, 0), none(rows()) {
    board.begin(at(0.0));
    claims.begin();
  }

  std::size_t rows() const { return plan->mission.rows.size(); }
  void publish() {
    MissionReport own;
    own.from = plan->fleet[0].id;
    own.claimed = claims.as_set();
    board.set_own(own);
  }
  MissionReport report_of(std::size_t robot) const {
    MissionReport report;
    report.from = plan->fleet[robot].id;
    report.stamp = at(1.0);
    report.position = plan->fleet[robot].start.position;
    report.done = report.claimed = report.failed = RowSet(rows());
    return report;
  }

  std::shared_ptr<const FleetPlan> plan;
  MissionBoard board;
  RowClaims claims;
  RowSet none;
};

TEST(RowClaims, BeginsWithThePlansRowsInItsOrder) {
  Robot robot(2);
  const auto& visits = robot.plan->division.routes[0].visits;
  ASSERT_EQ(robot.claims.queue().size(), visits.size());
  for (std::size_t k = 0; k < visits.size(); ++k)
    EXPECT_EQ(robot.plan->mission.rows[robot.claims.queue()[k]].id, visits[k].row);
  EXPECT_EQ(robot.claims.as_set().count(), visits.size());
  EXPECT_EQ(robot.claims.changes(), 0u);
}

TEST(RowClaims, TheRowUnderWayIsClaimedButNotQueued) {
  Robot robot(2);
  const std::size_t row = robot.claims.queue().front();
  robot.claims.start(row);
  EXPECT_EQ(robot.claims.current(), row);
  EXPECT_EQ(std::ranges::count(robot.claims.queue(), row), 0);
  EXPECT_EQ(robot.claims.all().back(), row);
  EXPECT_TRUE(robot.claims.as_set().has(row));
}

TEST(RowClaims, RowsThatAreDoneOrGivenUpAreDropped) {
  Robot robot(2);
  const std::vector<std::size_t> before = robot.claims.queue();
  ASSERT_GE(before.size(), 3u);
  RowSet abandoned(robot.rows());
  abandoned.set(before[1]);
  robot.board.set_done(before[0]);
  EXPECT_FALSE(robot.claims.drop_lost(robot.board, abandoned, at(1.0)));
  EXPECT_EQ(robot.claims.queue(), std::vector<std::size_t>(before.begin() + 2, before.end()));
}

TEST(RowClaims, TheRowUnderWayIsLostToARobotThatIsOnItAsWellOnlyIfThatGoesFirst) {
  // The first robot has the lower name and keeps its row; the second one loses it.
  for (const std::size_t self : {0u, 1u}) {
    const auto plan = plan_for(2);
    MissionBoard board(plan, self);
    RowClaims claims(plan, self);
    board.begin(at(0.0));
    claims.begin();
    const std::size_t row = claims.queue().front();
    claims.start(row);
    MissionReport other;
    other.from = plan->fleet[1 - self].id;
    other.stamp = at(1.0);
    other.current = static_cast<std::uint32_t>(row);
    other.done = other.failed = other.claimed = RowSet(plan->mission.rows.size());
    other.claimed.set(row);
    board.hear(other, at(1.0));
    EXPECT_EQ(claims.drop_lost(board, RowSet(plan->mission.rows.size()), at(1.0)), self == 1);
    EXPECT_EQ(claims.current().has_value(), self == 0);
  }
}

TEST(RowClaims, RowsOfALostRobotAreTakenOver) {
  Robot robot(2);
  const std::size_t own = robot.claims.queue().size();
  robot.publish();
  robot.claims.take_orphans(robot.board, robot.none, at(10.0));
  EXPECT_EQ(robot.claims.queue().size(), own);  // the other one may still come
  const double lost = robot.plan->config.executive.lost_after + 1.0;
  robot.claims.take_orphans(robot.board, robot.none, at(lost));
  EXPECT_EQ(robot.claims.as_set().count(), robot.rows());
  EXPECT_EQ(robot.claims.changes(), robot.rows() - own);
}

TEST(RowClaims, RowsThatItGaveUpItselfAreLeftToOthers) {
  Robot robot(2);
  robot.publish();
  RowSet abandoned(robot.rows());
  const RowId other = robot.plan->division.routes[1].visits.front().row;
  const auto row = std::ranges::find(robot.plan->mission.rows, other, &Row::id);
  const auto index = static_cast<std::size_t>(row - robot.plan->mission.rows.begin());
  abandoned.set(index);
  robot.claims.take_orphans(robot.board, abandoned, at(robot.plan->config.executive.lost_after + 1.0));
  EXPECT_FALSE(robot.claims.as_set().has(index));
  EXPECT_EQ(robot.claims.as_set().count(), robot.rows() - 1);
}

TEST(RowClaims, AnIdleRobotGetsRowsOncePerPeriod) {
  Robot robot(2);
  MissionReport idle = robot.report_of(1);
  for (const RowVisit& visit : robot.plan->division.routes[1].visits) {
    const auto row = std::ranges::find(robot.plan->mission.rows, visit.row, &Row::id);
    idle.done.set(static_cast<std::size_t>(row - robot.plan->mission.rows.begin()));
  }
  robot.publish();
  const Pose2 pose = robot.plan->fleet[0].start;
  const std::size_t before = robot.claims.queue().size();
  robot.claims.give_away(robot.board, 0.0, pose, at(0.5));  // the other one still has rows
  EXPECT_EQ(robot.claims.queue().size(), before);
  robot.board.hear(idle, at(1.0));
  robot.claims.give_away(robot.board, 0.0, pose, at(1.0));  // within the period of the last offer
  EXPECT_EQ(robot.claims.queue().size(), before);
  const double next = 1.0 + robot.plan->config.executive.offer_period;
  robot.claims.give_away(robot.board, 0.0, pose, at(next));
  EXPECT_LT(robot.claims.queue().size(), before);
  EXPECT_FALSE(robot.claims.queue().empty());
  EXPECT_EQ(robot.claims.changes(), before - robot.claims.queue().size());
}

TEST(RowClaims, ReleasingCountsEveryRow) {
  Robot robot(2);
  const std::size_t before = robot.claims.queue().size();
  robot.claims.start(robot.claims.queue().front());
  robot.claims.release_all();
  EXPECT_TRUE(robot.claims.all().empty());
  EXPECT_EQ(robot.claims.changes(), before);
}

}  // namespace
}  // namespace fleetmap::planning
