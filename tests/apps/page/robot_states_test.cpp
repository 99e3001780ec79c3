#include "page/robot_states.hpp"

#include <gmock/gmock.h>

#include "support/robots.hpp"

namespace fleetmap::apps {
namespace {

using fleetmap::testing::kPeer;
using fleetmap::testing::kSelf;
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
    fleet_.self = kSelf;
    fleet_.fleet = {kPeer, kSelf};
    fleet_.now = Stamp{1000s};
    for (const planning::RowId id : {70u, 71u, 72u, 73u}) {  // 100 m to the north, 10 m apart
      const double east = 10.0 * (id - 70);
      fleet_.rows.push_back({id, {{east, 0.0}, {east, 100.0}}});
    }
  }
  monitor::RobotNow of(const AgentId& id) const {
    const auto robots = robot_states(fleet_);
    EXPECT_EQ(robots.size(), 2u);
    return id == kSelf ? robots.at(0) : robots.at(1);
  }
  void order(bool hold) { fleet_.orders = {{Stamp{1s}, kPeer, kSelf, hold ? Kind::kHold : Kind::kResume}}; }

  FleetState fleet_;
};

TEST_F(RobotsNow, EveryRobotOfTheFleetIsThereByNameAlsoUnheard) {
  EXPECT_EQ(of(kSelf).id, kSelf);
  EXPECT_EQ(of(kPeer).activity, "was not heard yet");
  EXPECT_THAT(of(kPeer).heard, IsEmpty());
}

TEST_F(RobotsNow, ActivityFollowsFromTheMissionReport) {
  const auto words = [&](MissionState state, std::uint32_t current) {
    return activity_of(report(state, current, 4, 1), fleet_.rows, std::nullopt, std::nullopt);
  };
  EXPECT_EQ(words(MissionState::kDriving, 2), "drives row 72, 25 % of the rows are driven");
  EXPECT_THAT(words(MissionState::kDriving, messages::MissionReport::kNoRow), HasSubstr("between two rows"));
  EXPECT_THAT(words(MissionState::kDriving, 4), HasSubstr("between two rows")) << "of another mission";
  EXPECT_THAT(words(MissionState::kMeeting, 0), HasSubstr("waits where all meet"));
  EXPECT_THAT(words(MissionState::kStuck, 0), HasSubstr("stuck"));
  EXPECT_EQ(activity_of(report(MissionState::kDone, 0, 0, 0), {}, std::nullopt, std::nullopt), "is done");
  EXPECT_EQ(activity_of(report(MissionState::kDone, 0, 40, 40), fleet_.rows, 0.0, std::nullopt),
            "is done, 100 % of the rows are driven");
}

TEST_F(RobotsNow, PlaceAndHeadingTellHowFarItIsOnItsRow) {
  fleet_.reports[kPeer] = report(MissionState::kDriving, 1, 4, 1);
  fleet_.reports[kPeer].position = {10.5, 30.0};
  fleet_.statuses[kPeer].heading = 1.5f;
  EXPECT_EQ(of(kPeer).activity, "drives row 71 (30 % of it), 25 % of the rows are driven");
  fleet_.statuses[kPeer].heading = -1.5f;
  EXPECT_THAT(of(kPeer).activity, HasSubstr("drives row 71 (70 % of it)"));
  fleet_.reports[kPeer].position = {20.0, 30.0};
  EXPECT_THAT(of(kPeer).activity, HasSubstr("is on its way to row 71,"));
}

TEST_F(RobotsNow, WithoutAMissionTheStatusSaysWhetherItMaps) {
  fleet_.statuses[kPeer].busy = true;
  EXPECT_EQ(of(kPeer).activity, "maps");
  fleet_.statuses[kPeer].busy = false;
  EXPECT_EQ(of(kPeer).activity, "has nothing left to map or to exchange");
}

TEST_F(RobotsNow, TheStatusIsTakenOver) {
  messages::AgentStatus& status = fleet_.statuses[kPeer];
  status.nodes = 5;
  status.submaps = 3;
  status.backlog_bytes = 900;
  EXPECT_FALSE(of(kPeer).battery) << "negative: unknown";
  status.battery = 0.5f;
  EXPECT_EQ(of(kPeer).battery, 0.5);
  EXPECT_EQ(of(kPeer).nodes, 5u);
  EXPECT_EQ(of(kPeer).submaps, 3u);
  EXPECT_EQ(of(kPeer).backlog_bytes, 900u);
}

TEST_F(RobotsNow, ThePlaceOfAStatusCountsOnceItsPoseIsKnown) {
  messages::AgentStatus& status = fleet_.statuses[kPeer];
  status.position = geo_point_from_degrees(39.0, -3.0, 600.0);
  status.heading = 1.5f;
  status.stamp = Stamp{7s};
  EXPECT_FALSE(of(kPeer).place) << "without a pose the place is zero or old";
  status.position_stddev = 0.5f;
  const auto place = of(kPeer).place;
  ASSERT_TRUE(place);
  EXPECT_EQ(place->position.latitude, status.position.latitude);
  EXPECT_EQ(place->heading, 1.5);
  EXPECT_EQ(place->stamp, Stamp{7s});
}

TEST_F(RobotsNow, TheLinkOnWhichItWasHeardLastComesFirst) {
  fleet_.heard[{bus::Link::kShortRange, kPeer}] = {Stamp{900s}, true};
  fleet_.heard[{bus::Link::kLongRange, kPeer}] = {Stamp{997s}, false};
  const auto heard = of(kPeer).heard;
  ASSERT_EQ(heard.size(), 2u);
  EXPECT_EQ(heard[0].link, "long_range");
  EXPECT_DOUBLE_EQ(heard[0].seconds_ago, 3.0);
  EXPECT_DOUBLE_EQ(heard[1].seconds_ago, 100.0);
  EXPECT_THAT(of(kSelf).heard, IsEmpty());
}

TEST_F(RobotsNow, AnOrderCountsOnceTheRobotHasAnswered) {
  EXPECT_TRUE(of(kPeer).driven) << "it has said nothing yet";
  fleet_.reports[kPeer] = report(MissionState::kDriving, 1, 4, 0);
  order(true);
  EXPECT_TRUE(of(kPeer).ordered_to_hold);
  EXPECT_TRUE(of(kPeer).driven);
  EXPECT_THAT(of(kPeer).activity, HasSubstr("drives row 71"));
  EXPECT_THAT(of(kPeer).problems, ElementsAre("has not confirmed the order to stand still"));
  fleet_.driving[kPeer] = Hold::Driving::kHeld;
  EXPECT_EQ(of(kPeer).activity, "stands still: an operator holds it");
  EXPECT_THAT(of(kPeer).problems, IsEmpty());
  order(false);
  EXPECT_FALSE(of(kPeer).ordered_to_hold);
  fleet_.driving[kPeer] = Hold::Driving::kFree;
  EXPECT_THAT(of(kPeer).activity, HasSubstr("drives row 71"));
  fleet_.driving[kPeer] = Hold::Driving::kNoMission;
  EXPECT_FALSE(of(kPeer).driven);
  EXPECT_FALSE(of(kSelf).ordered_to_hold);
}

TEST_F(RobotsNow, ACallHomeAndAGivenRowCountOnceTheRobotHasAnswered) {
  fleet_.reports[kPeer] = report(MissionState::kDriving, 1, 4, 0);
  fleet_.reports[kPeer].claimed = messages::RowSet(4);
  fleet_.reports[kPeer].claimed.set(1);
  fleet_.reports[kPeer].claimed.set(3);
  EXPECT_THAT(of(kPeer).rows, ElementsAre(71u, 73u));
  fleet_.row_orders = {{Stamp{1s}, kSelf, kPeer, kSelf, 72},
                       {Stamp{1s}, kSelf, kPeer, kSelf, 73},
                       {Stamp{1s}, kSelf, kPeer, kSelf, 9}};
  EXPECT_THAT(of(kPeer).problems, ElementsAre("has not taken over row 72 yet"))
      << "it has 73, and there is no row 9";
  fleet_.reports[kPeer].done.set(2);
  EXPECT_THAT(of(kPeer).problems, IsEmpty());
  fleet_.orders = {{Stamp{1s}, kPeer, kSelf, Kind::kHome}};
  EXPECT_TRUE(of(kPeer).called_home);
  EXPECT_FALSE(of(kPeer).ordered_to_hold);
  EXPECT_THAT(of(kPeer).problems, ElementsAre("has not confirmed the order to drive home"));
  fleet_.driving[kPeer] = Hold::Driving::kHome;
  fleet_.reports[kPeer].state = MissionState::kCalledHome;
  EXPECT_THAT(of(kPeer).problems, IsEmpty());
  EXPECT_THAT(of(kPeer).activity, HasSubstr("was called home and gave its rows away"));
  fleet_.orders[0].kind = Kind::kHoldHome;
  EXPECT_TRUE(of(kPeer).called_home && of(kPeer).ordered_to_hold);
  EXPECT_THAT(of(kPeer).problems, ElementsAre("has not confirmed the order to stand still"));
  fleet_.driving[kPeer] = Hold::Driving::kHeld;
  EXPECT_THAT(of(kPeer).problems, IsEmpty());
  EXPECT_EQ(of(kPeer).activity, "stands still: an operator holds it on its way home");
}

TEST_F(RobotsNow, ARobotThatWasCalledHomeIsOnItsWayOrBackAtItsStart) {
  fleet_.starts[kPeer] = {0.0, -20.0};
  fleet_.reports[kPeer] = report(MissionState::kCalledHome, messages::MissionReport::kNoRow, 4, 1);
  fleet_.reports[kPeer].position = {0.0, 14.0};
  EXPECT_EQ(of(kPeer).activity,
            "was called home and gave its rows away: 34 m from its start, 25 % of the rows are driven");
  fleet_.reports[kPeer].position = {1.0, -21.0};
  EXPECT_THAT(of(kPeer).activity, HasSubstr("gave its rows away: it is back at its start, "));
}

TEST_F(RobotsNow, HealthAndClockOfAnotherRobotComeWithItsStatus) {
  EXPECT_FALSE(of(kPeer).clock);
  messages::AgentStatus& status = fleet_.statuses[kPeer];
  status.health = {messages::Health::kNoScan, 2, messages::clock_code(-2.0)};
  EXPECT_THAT(of(kPeer).problems, ElementsAre("no scan comes from its LiDAR"));
  ASSERT_TRUE(of(kPeer).clock);
  EXPECT_EQ(of(kPeer).clock->sensor, "gps");
  EXPECT_NEAR(of(kPeer).clock->behind_s, -2.0, 0.1);
  fleet_.problems[kPeer] = {"no scan for 7 s"};
  EXPECT_THAT(of(kPeer).problems, ElementsAre("no scan for 7 s"))
      << "of a robot whose insides are known, those";
}

TEST_F(RobotsNow, StopReasonOfTheOwnRobotIsShown) {
  fleet_.reports[kSelf] = report(MissionState::kDriving, 1, 4, 0);
  fleet_.stop_reason = "no scan comes";
  fleet_.problems[kSelf] = {"no scan for 7 s"};
  EXPECT_EQ(of(kSelf).activity, "stands still: no scan comes");
  EXPECT_THAT(of(kSelf).problems, ElementsAre("no scan for 7 s"));
  EXPECT_THAT(of(kPeer).problems, IsEmpty());
}

TEST_F(RobotsNow, MisbehaviourIsAProblemOfTheSender) {
  fleet_.misbehaved[kPeer] = 4;
  EXPECT_THAT(of(kPeer).problems, ElementsAre("sent 4 messages that contradict the rules"));
}

TEST_F(RobotsNow, ALostRobotIsAProblemWhichEndsOnceItIsHeardAgain) {
  monitor::RobotNow robot = of(kPeer);
  add_silence(60.0, robot);
  EXPECT_THAT(robot.problems, IsEmpty()) << "it was not heard yet";
  robot.heard = {{"long_range", 60.0}, {"short_range", 90.0}};
  add_silence(60.0, robot);
  EXPECT_THAT(robot.problems, IsEmpty());
  robot.heard.front().seconds_ago = 61.0;
  robot.problems = {"no scan comes from its LiDAR"};
  add_silence(60.0, robot);
  EXPECT_THAT(robot.problems, ElementsAre("is heard on no radio", "no scan comes from its LiDAR"));
}

TEST_F(RobotsNow, WhatIsCountedSinceTheStartIsAmongTheProblemsAndNamed) {
  using messages::Health;
  fleet_.statuses[kPeer].health.problems = Health::kNoScan | Health::kDiskRefuses | Health::kScansNotMatched;
  EXPECT_THAT(of(kPeer).totals,
              ElementsAre("its disk refused writes", "its odometry could not match some scans"));
  EXPECT_THAT(of(kPeer).problems, ElementsAre("no scan comes from its LiDAR", "its disk refused writes",
                                              "its odometry could not match some scans"));
  fleet_.problems[kSelf] = {};
  fleet_.totals[kSelf] = {"the disk refused 3 writes"};
  EXPECT_THAT(of(kSelf).problems, ElementsAre("the disk refused 3 writes"));
  EXPECT_THAT(of(kSelf).totals, ElementsAre("the disk refused 3 writes"));
}

}  // namespace
}  // namespace fleetmap::apps
