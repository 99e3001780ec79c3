#include "page/problem_log.hpp"

#include <gmock/gmock.h>

#include "support/robots.hpp"

namespace fleetmap::apps {
namespace {

using fleetmap::testing::kPeer;
using fleetmap::testing::kSelf;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using namespace std::chrono_literals;

class ProblemLogTest : public ::testing::Test {
 protected:
  monitor::RobotNow at(Duration time, std::vector<std::string> problems, std::vector<std::string> totals = {},
                       const AgentId& id = kPeer) {
    monitor::RobotNow robot;
    robot.id = id;
    robot.problems = std::move(problems);
    robot.problems.insert(robot.problems.end(), totals.begin(), totals.end());
    robot.totals = std::move(totals);
    log_.update(robot, Stamp{1000s} + time);
    return robot;
  }
  ProblemLog log_;
};

TEST_F(ProblemLogTest, AProblemThatIsGoneIsPastWithItsEndAndItsLastNumbers) {
  EXPECT_THAT(at(0s, {"no scan for 6 s"}).past, IsEmpty());
  EXPECT_THAT(at(1s, {"no scan for 7 s"}).problems, ElementsAre("no scan for 7 s"));
  const auto after = at(31s, {});
  EXPECT_THAT(after.problems, IsEmpty());
  ASSERT_THAT(after.past, SizeIs(1));
  EXPECT_EQ(after.past[0].text, "no scan for 7 s");
  EXPECT_EQ(after.past[0].seconds_ago, 30.0);
  EXPECT_FALSE(after.past[0].is_total);
  EXPECT_THAT(at(32s, {"no scan for 6 s"}).past, IsEmpty()) << "it is back";
  EXPECT_THAT(at(2h, {}).past, IsEmpty()) << "an hour ago nobody cares";
}

TEST_F(ProblemLogTest, ATotalIsAProblemWhileItGrows) {
  at(0s, {});
  EXPECT_THAT(at(1s, {}, {"the disk refused 3 writes"}).problems, ElementsAre("the disk refused 3 writes"));
  EXPECT_THAT(at(50s, {}, {"the disk refused 4 writes"}).past, IsEmpty());
  EXPECT_THAT(at(109s, {}, {"the disk refused 4 writes"}).past, IsEmpty());
  const auto later = at(110s, {}, {"the disk refused 4 writes"});
  EXPECT_THAT(later.problems, IsEmpty());
  ASSERT_THAT(later.past, SizeIs(1));
  EXPECT_TRUE(later.past[0].is_total);
  EXPECT_EQ(later.past[0].seconds_ago, 60.0);
  EXPECT_THAT(at(3h, {}, {"the disk refused 4 writes"}).past, SizeIs(1)) << "it still counts";
  EXPECT_THAT(at(3h + 1s, {}, {"the disk refused 5 writes"}).problems, SizeIs(1));
}

TEST_F(ProblemLogTest, NothingShowsWhenATotalGrewBeforeTheFirstLook) {
  const auto first = at(0s, {}, {"its disk refused writes"});
  EXPECT_THAT(first.problems, IsEmpty());
  ASSERT_THAT(first.past, SizeIs(1));
  EXPECT_FALSE(first.past[0].seconds_ago);
}

TEST_F(ProblemLogTest, TheNewestAreShownFirstAndOnlySome) {
  for (int k = 0; k < 8; ++k) at(1s * k, {std::string("finding ") + static_cast<char>('a' + k)});
  const auto after = at(9s, {});
  ASSERT_THAT(after.past, SizeIs(5));
  EXPECT_EQ(after.past.front().text, "finding h");
  EXPECT_EQ(after.past.back().text, "finding d");
}

TEST_F(ProblemLogTest, RobotsAreKeptApart) {
  at(0s, {"no scan for 6 s"}, {}, kSelf);
  EXPECT_THAT(at(1s, {}).past, IsEmpty());
  EXPECT_THAT(at(1s, {}, {}, kSelf).past, SizeIs(1));
}

}  // namespace
}  // namespace fleetmap::apps
