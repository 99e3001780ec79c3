#include "mission/appointments.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "planning/mission/small_plan.hpp"

namespace fleetmap::planning {
namespace {

using testing::at;
using Partner = Appointments::Partner;

constexpr std::size_t kSelf = 0, kOther = 1;
constexpr std::size_t kAfter = 2, kOtherAfter = 1;  ///< rows before the first stop

Detour stop_after(std::size_t own, std::size_t other, double arrival, double other_arrival, double leave) {
  Detour detour;
  detour.parts[0] = {kSelf, own, {1.0, 2.0}, arrival};
  detour.parts[1] = {kOther, other, {3.0, 4.0}, other_arrival};
  detour.leave = leave;
  return detour;
}

/// A plan of two robots with two stops, the later one found first.
class AppointmentsTest : public ::testing::Test {
 protected:
  AppointmentsTest() {
    auto plan = std::make_shared<FleetPlan>(*testing::plan_for(2));
    plan->exchange->stops = {stop_after(4, 3, 300.0, 280.0, 310.0),
                             stop_after(kAfter, kOtherAfter, 100.0, 120.0, 150.0)};
    plan_ = plan;
    board_.emplace(plan_, kSelf);
    board_->begin(at(0.0));
  }
  std::size_t row_of(std::size_t robot, std::size_t k) const {
    const RowId id = plan_->division.routes[robot].visits.at(k).row;
    return static_cast<std::size_t>(std::ranges::find(plan_->mission.rows, id, &Row::id) -
                                    plan_->mission.rows.begin());
  }
  std::size_t rows_of(std::size_t robot) const { return plan_->division.routes[robot].visits.size(); }
  /// Rows of a robot from the k-th on.
  std::vector<std::size_t> rows_from(std::size_t robot, std::size_t k) const {
    std::vector<std::size_t> rows;
    for (; k < rows_of(robot); ++k) rows.push_back(row_of(robot, k));
    return rows;
  }
  /// The partner reports that it still has these rows, and which it drives.
  void partner_reports(const std::vector<std::size_t>& claimed, std::optional<std::size_t> current = {},
                       MissionState state = MissionState::kDriving) {
    MissionReport report;
    report.from = plan_->fleet[kOther].id;
    report.stamp = at(++reports_);
    report.state = state;
    report.claimed = RowSet(plan_->mission.rows.size());
    for (const std::size_t row : claimed) report.claimed.set(row);
    if (current) report.current = static_cast<std::uint32_t>(*current);
    board_->hear(report, at(reports_));
  }
  Partner partner(std::size_t partner_after = kOtherAfter) const {
    const Appointments appointments(*plan_, kSelf);
    Appointments::Stop stop = *appointments.next();
    stop.partner_after = partner_after;
    return appointments.partner(stop, *board_, at(reports_));
  }

  std::shared_ptr<const FleetPlan> plan_;
  std::optional<MissionBoard> board_;
  double reports_ = 0.0;
};

TEST_F(AppointmentsTest, AreThoseOfThePlanInTheOrderInWhichTheyCome) {
  ASSERT_GE(rows_of(kSelf), 5u);
  Appointments own(*plan_, kSelf);
  ASSERT_TRUE(own.next());
  EXPECT_EQ(own.next()->partner, kOther);
  EXPECT_EQ(own.next()->after, kAfter);
  EXPECT_EQ(own.next()->partner_after, kOtherAfter);
  EXPECT_EQ(own.next()->place, Eigen::Vector2d(1.0, 2.0));
  EXPECT_EQ(own.next()->arrival, 100.0);
  EXPECT_EQ(own.next()->partner_arrival, 120.0);
  EXPECT_EQ(own.next()->transfer, 30.0) << "from when both are there";
  own.kept();
  ASSERT_TRUE(own.next());
  EXPECT_EQ(own.next()->after, 4u);
  EXPECT_EQ(own.next()->transfer, 10.0);
  own.dropped();
  EXPECT_FALSE(own.next());
  EXPECT_EQ(own.count_kept(), 1u);
  EXPECT_EQ(own.count_dropped(), 1u);
  const Appointments other(*plan_, kOther);
  ASSERT_TRUE(other.next());
  EXPECT_EQ(other.next()->partner, kSelf);
  EXPECT_EQ(other.next()->after, kOtherAfter);
  EXPECT_EQ(other.next()->place, Eigen::Vector2d(3.0, 4.0));
  EXPECT_EQ(other.next()->partner_arrival, 100.0);
}

TEST_F(AppointmentsTest, WithoutStopsNoOrderIsKept) {
  EXPECT_TRUE(Appointments(*plan_, kSelf).keeps_order());
  FleetPlan plan = *plan_;
  plan.exchange->stops.clear();
  EXPECT_FALSE(Appointments(plan, kSelf).keeps_order());
  EXPECT_FALSE(Appointments(plan, kSelf).next());
  plan.exchange.reset();
  EXPECT_FALSE(Appointments(plan, kSelf).keeps_order());
}

TEST_F(AppointmentsTest, AStopIsDueBetweenItsRows) {
  Appointments appointments(*plan_, kSelf);
  for (std::size_t driven = 0; driven <= kAfter; ++driven) {
    const auto mine = rows_from(kSelf, driven);
    appointments.update(mine, std::nullopt);
    EXPECT_EQ(appointments.due(mine), driven == kAfter) << driven;
    EXPECT_EQ(appointments.next_visit(mine).row, row_of(kSelf, driven));
    EXPECT_EQ(appointments.next_visit(mine).reversed, plan_->division.routes[kSelf].visits[driven].reversed);
    if (driven == kAfter) break;
    appointments.update(mine, row_of(kSelf, driven));
    EXPECT_FALSE(appointments.due(mine)) << "it drives a row";
  }
  EXPECT_EQ(appointments.next()->after, kAfter);
  // It has gone on.
  appointments.update(rows_from(kSelf, kAfter), row_of(kSelf, kAfter));
  EXPECT_EQ(appointments.next()->after, 4u);
  EXPECT_EQ(appointments.count_dropped(), 1u);
  EXPECT_TRUE(appointments.keeps_order());
}

TEST_F(AppointmentsTest, RobotThatTakesGivesOrReordersRowsHasNoAppointments) {
  const auto drops_all = [&](const std::vector<std::size_t>& mine, std::optional<std::size_t> current = {}) {
    Appointments appointments(*plan_, kSelf);
    appointments.update(mine, current);
    EXPECT_EQ(appointments.keeps_order(), appointments.next() != nullptr);
    return appointments.next() == nullptr && appointments.count_dropped() == 2;
  };
  std::vector<std::size_t> mine = rows_from(kSelf, 0);
  EXPECT_FALSE(drops_all(mine));
  std::ranges::reverse(mine);
  EXPECT_FALSE(drops_all(mine)) << "the order in which it keeps them is no matter";
  EXPECT_TRUE(drops_all(mine, row_of(kSelf, 1))) << "the second row before the first";
  mine.push_back(row_of(kOther, 0));
  EXPECT_TRUE(drops_all(mine)) << "one more";
  mine = rows_from(kSelf, 0);
  mine.front() = row_of(kOther, 0);
  EXPECT_TRUE(drops_all(mine)) << "another one";
  mine = rows_from(kSelf, 0);
  mine.erase(mine.begin() + 1);
  EXPECT_TRUE(drops_all(mine)) << "the second one is gone before the first";
}

TEST_F(AppointmentsTest, ThePartnerComesUntilItHasDrivenItsRows) {
  EXPECT_EQ(partner(), Partner::kComing) << "before its first report";
  partner_reports(rows_from(kOther, 0), row_of(kOther, 0));
  EXPECT_EQ(partner(), Partner::kComing);
  partner_reports(rows_from(kOther, 1));
  EXPECT_EQ(partner(), Partner::kDue);
  partner_reports(rows_from(kOther, 1), row_of(kOther, 1));
  EXPECT_EQ(partner(), Partner::kGone) << "it has gone on";
  partner_reports(rows_from(kOther, 2));
  EXPECT_EQ(partner(), Partner::kGone);
}

TEST_F(AppointmentsTest, APartnerThatChangedItsRowsIsGone) {
  partner_reports(rows_from(kOther, 1));
  ASSERT_EQ(partner(), Partner::kDue);
  std::vector<std::size_t> more = rows_from(kOther, 0);
  more.push_back(row_of(kSelf, 4));
  partner_reports(more);
  EXPECT_EQ(partner(), Partner::kGone) << "more than it had";
  std::vector<std::size_t> other = rows_from(kOther, 1);
  other.back() = row_of(kSelf, 4);
  partner_reports(other);
  EXPECT_EQ(partner(), Partner::kGone) << "another one";
  partner_reports(rows_from(kOther, 0), row_of(kOther, 2));
  EXPECT_EQ(partner(), Partner::kGone) << "in another order";
}

TEST_F(AppointmentsTest, APartnerThatIsLostOrCannotDriveIsGone) {
  for (const MissionState state : {MissionState::kStuck, MissionState::kLowBattery, MissionState::kDone}) {
    partner_reports(rows_from(kOther, 1), {}, state);
    EXPECT_EQ(partner(), Partner::kGone) << to_string(state);
    partner_reports(rows_from(kOther, 1));
    EXPECT_EQ(partner(), Partner::kDue);
  }
  reports_ += plan_->config.executive.lost_after + 1.0;
  EXPECT_EQ(partner(), Partner::kGone) << "nothing was heard of it";
}

TEST_F(AppointmentsTest, AfterItsLastRowThePartnerIsDueUntilItIsAtTheMeeting) {
  partner_reports({});
  EXPECT_EQ(partner(rows_of(kOther)), Partner::kDue);
  partner_reports({}, {}, MissionState::kMeeting);
  EXPECT_EQ(partner(rows_of(kOther)), Partner::kGone);
}

}  // namespace
}  // namespace fleetmap::planning
