#include "page/robot_states.hpp"

#include <gmock/gmock.h>

#include "apps/two_robots.hpp"

namespace fleetmap::apps {
namespace {

using messages::Hold;
using messages::MissionState;
using Kind = messages::HoldOrder::Kind;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using namespace std::chrono_literals;

messages::MissionReport report(MissionState state, std::uint32_t current, std::size_t rows,
                               std::size_t done) {
  messages::MissionReport report;
  report.state = state;
  report.current = current;
  report.done = messages::RowSet(rows);
  for (std::size_t row = 0; row < done; ++row) report.done.set(row);
  return report;
}

class RobotsNow : public ::testing::Test {
 protected:
  RobotsNow() {
    fleet_.self = kR1;
    fleet_.fleet = {kR2, kR1};
    fleet_.now = Stamp{1000s};
    for (const planning::RowId id : {70u, 71u, 72u, 73u}) {  // 100 m to the north, 10 m apart
      const double east = 10.0 * (id - 70);
      fleet_.rows.push_back({id, {{east, 0.0}, {east, 100.0}}});
    }
  }
  monitor::RobotNow of(const AgentId& id) const {
    const auto robots = robot_states(fleet_);
    EXPECT_EQ(robots.size(), 2u);
    return id == kR1 ? robots.at(0) : robots.at(1);
  }
  void order(bool hold) { fleet_.orders = {{Stamp{1s}, kR2, kR1, hold ? Kind::kHold : Kind::kResume}}; }

  FleetState fleet_;
};

TEST_F(RobotsNow, EveryRobotOfTheFleetIsThereByNameAlsoUnheard) {
  EXPECT_EQ(of(kR1).id, kR1);
  EXPECT_EQ(of(kR2).activity, "was not heard yet");
  EXPECT_THAT(of(kR2).heard, IsEmpty());
}

TEST_F(RobotsNow, ActivityFollowsFromTheMissionReport) {
  const auto words = [&](MissionState state, std::uint32_t current) {
    return activity_of(report(state, current, 4, 1), fleet_.rows, std::nullopt);
  };
  EXPECT_EQ(words(MissionState::kDriving, 2), "drives row 72, 25 % of the rows are driven");
  EXPECT_THAT(words(MissionState::kDriving, messages::MissionReport::kNoRow), HasSubstr("between two rows"));
  EXPECT_THAT(words(MissionState::kDriving, 4), HasSubstr("between two rows")) << "of another mission";
  EXPECT_THAT(words(MissionState::kMeeting, 0), HasSubstr("waits where all meet"));
  EXPECT_THAT(words(MissionState::kStuck, 0), HasSubstr("stuck"));
  EXPECT_EQ(activity_of(report(MissionState::kDone, 0, 0, 0), {}, std::nullopt), "is done");
  EXPECT_EQ(activity_of(report(MissionState::kDone, 0, 40, 40), fleet_.rows, 0.0),
            "is done, 100 % of the rows are driven");
}

TEST_F(RobotsNow, PlaceAndHeadingTellHowFarItIsOnItsRow) {
  fleet_.reports[kR2] = report(MissionState::kDriving, 1, 4, 1);
  fleet_.reports[kR2].position = {10.5, 30.0};
  fleet_.statuses[kR2].heading = 1.5f;
  EXPECT_EQ(of(kR2).activity, "drives row 71 (30 % of it), 25 % of the rows are driven");
  fleet_.statuses[kR2].heading = -1.5f;
  EXPECT_THAT(of(kR2).activity, HasSubstr("drives row 71 (70 % of it)"));
  fleet_.reports[kR2].position = {20.0, 30.0};
  EXPECT_THAT(of(kR2).activity, HasSubstr("is on its way to row 71,"));
}

TEST_F(RobotsNow, WithoutAMissionTheStatusSaysWhetherItMaps) {
  fleet_.statuses[kR2].busy = true;
  EXPECT_EQ(of(kR2).activity, "maps");
  fleet_.statuses[kR2].busy = false;
  EXPECT_EQ(of(kR2).activity, "has nothing left to map or to exchange");
}

TEST_F(RobotsNow, TheStatusIsTakenOver) {
  messages::AgentStatus& status = fleet_.statuses[kR2];
  status.nodes = 5;
  status.submaps = 3;
  status.backlog_bytes = 900;
  EXPECT_FALSE(of(kR2).battery) << "negative: unknown";
  status.battery = 0.5f;
  EXPECT_EQ(of(kR2).battery, 0.5);
  EXPECT_EQ(of(kR2).nodes, 5u);
  EXPECT_EQ(of(kR2).submaps, 3u);
  EXPECT_EQ(of(kR2).backlog_bytes, 900u);
}

TEST_F(RobotsNow, TheLinkOnWhichItWasHeardLastComesFirst) {
  fleet_.heard[{bus::Link::kShortRange, kR2}] = {Stamp{900s}, true};
  fleet_.heard[{bus::Link::kLongRange, kR2}] = {Stamp{997s}, false};
  const auto heard = of(kR2).heard;
  ASSERT_EQ(heard.size(), 2u);
  EXPECT_EQ(heard[0].link, "long_range");
  EXPECT_DOUBLE_EQ(heard[0].seconds_ago, 3.0);
  EXPECT_DOUBLE_EQ(heard[1].seconds_ago, 100.0);
  EXPECT_THAT(of(kR1).heard, IsEmpty());
}

TEST_F(RobotsNow, AnOrderCountsOnceTheRobotHasAnswered) {
  EXPECT_TRUE(of(kR2).driven) << "it has said nothing yet";
  fleet_.reports[kR2] = report(MissionState::kDriving, 1, 4, 0);
  order(true);
  EXPECT_TRUE(of(kR2).ordered_to_hold);
  EXPECT_TRUE(of(kR2).driven);
  EXPECT_THAT(of(kR2).activity, HasSubstr("drives row 71"));
  EXPECT_THAT(of(kR2).problems, ElementsAre("has not confirmed the order to stand still"));
  fleet_.driving[kR2] = Hold::Driving::kHeld;
  EXPECT_EQ(of(kR2).activity, "stands still: an operator holds it");
  EXPECT_THAT(of(kR2).problems, IsEmpty());
  order(false);
  EXPECT_FALSE(of(kR2).ordered_to_hold);
  fleet_.driving[kR2] = Hold::Driving::kFree;
  EXPECT_THAT(of(kR2).activity, HasSubstr("drives row 71"));
  fleet_.driving[kR2] = Hold::Driving::kNoMission;
  EXPECT_FALSE(of(kR2).driven);
  EXPECT_FALSE(of(kR1).ordered_to_hold);
}

TEST_F(RobotsNow, ACallHomeAndAGivenRowCountOnceTheRobotHasAnswered) {
  fleet_.reports[kR2] = report(MissionState::kDriving, 1, 4, 0);
  fleet_.reports[kR2].claimed = messages::RowSet(4);
  fleet_.reports[kR2].claimed.set(1);
  fleet_.reports[kR2].claimed.set(3);
  EXPECT_THAT(of(kR2).rows, ElementsAre(71u, 73u));
  fleet_.row_orders = {
      {Stamp{1s}, kR1, kR2, kR1, 72}, {Stamp{1s}, kR1, kR2, kR1, 73}, {Stamp{1s}, kR1, kR2, kR1, 9}};
  EXPECT_THAT(of(kR2).problems, ElementsAre("has not taken over row 72 yet"))
      << "it has 73, and there is no row 9";
  fleet_.reports[kR2].done.set(2);
  EXPECT_THAT(of(kR2).problems, IsEmpty());
  fleet_.orders = {{Stamp{1s}, kR2, kR1, Kind::kHome}};
  EXPECT_TRUE(of(kR2).called_home);
  EXPECT_FALSE(of(kR2).ordered_to_hold);
  EXPECT_THAT(of(kR2).problems, ElementsAre("has not confirmed the order to drive home"));
  fleet_.driving[kR2] = Hold::Driving::kHome;
  fleet_.reports[kR2].state = MissionState::kCalledHome;
  EXPECT_THAT(of(kR2).problems, IsEmpty());
  EXPECT_THAT(of(kR2).activity, HasSubstr("was called home and gave its rows away"));
  fleet_.orders[0].kind = Kind::kHoldHome;
  EXPECT_TRUE(of(kR2).called_home && of(kR2).ordered_to_hold);
  EXPECT_THAT(of(kR2).problems, ElementsAre("has not confirmed the order to stand still"));
  fleet_.driving[kR2] = Hold::Driving::kHeld;
  EXPECT_THAT(of(kR2).problems, IsEmpty());
  EXPECT_EQ(of(kR2).activity, "stands still: an operator holds it on its way home");
}

TEST_F(RobotsNow, HealthAndClockOfAnotherRobotComeWithItsStatus) {
  EXPECT_FALSE(of(kR2).clock);
  messages::AgentStatus& status = fleet_.statuses[kR2];
  status.health = {messages::Health::kNoScan, 2, messages::clock_code(-2.0)};
  EXPECT_THAT(of(kR2).problems, ElementsAre("no scan comes from its LiDAR"));
  ASSERT_TRUE(of(kR2).clock);
  EXPECT_EQ(of(kR2).clock->sensor, "gps");
  EXPECT_NEAR(of(kR2).clock->behind_s, -2.0, 0.1);
  fleet_.problems[kR2] = {"no scan for 7 s"};
  EXPECT_THAT(of(kR2).problems, ElementsAre("no scan for 7 s"))
      << "of a robot whose insides are known, those";
}

TEST_F(RobotsNow, StopReasonOfTheOwnRobotIsShown) {
  fleet_.reports[kR1] = report(MissionState::kDriving, 1, 4, 0);
  fleet_.stop_reason = "no scan comes";
  fleet_.problems[kR1] = {"no scan for 7 s"};
  EXPECT_EQ(of(kR1).activity, "stands still: no scan comes");
  EXPECT_THAT(of(kR1).problems, ElementsAre("no scan for 7 s"));
  EXPECT_THAT(of(kR2).problems, IsEmpty());
}

TEST_F(RobotsNow, MisbehaviourIsAProblemOfTheSender) {
  fleet_.misbehaved[kR2] = 4;
  EXPECT_THAT(of(kR2).problems, ElementsAre("sent 4 messages that contradict the rules"));
}

}  // namespace
}  // namespace fleetmap::apps
