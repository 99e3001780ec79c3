#include "report/run_summary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "store/items.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A lone robot that was switched off, and whose store held a map.
class RunSummary : public ::testing::Test {
 protected:
  RunSummary() {
    auto& entry = outcome_.agents.emplace_back();
    entry.id = testing::agent("r1");
    output::Results& results = entry.results.emplace();
    results.map.points = 1234;
    results.map.submaps = 5;
    results.map.hash = "0123456789abcdef";
  }
  std::string printed() const {
    std::ostringstream out;
    print_summary(out, outcome_, "out");
    return out.str();
  }
  FleetOutcome outcome_;
};

TEST_F(RunSummary, NamesTheMapOfEachRobotOrWhyThereIsNone) {
  EXPECT_THAT(printed(), HasSubstr("r1: switched off; what its store held:\n"));
  EXPECT_THAT(printed(), HasSubstr("r1: out/r1/map.ply  1234 points from 5 submaps, hash 0123456789ab\n"));
  outcome_.agents[0].results.reset();
  EXPECT_THAT(printed(), HasSubstr("r1: no map: it made no node\n"));
  outcome_.agents[0].problem = "its disk is full";
  EXPECT_THAT(printed(), HasSubstr("r1: no map: its disk is full\n"));
}

TEST_F(RunSummary, NamesWhatCouldNotBeReadOfARecording) {
  EXPECT_THAT(printed(), Not(HasSubstr("damaged")));
  outcome_.agents[0].recording.damaged_parts = 1;
  EXPECT_THAT(printed(), HasSubstr("r1: 1 part of the recording is damaged or cut off"));
}

TEST_F(RunSummary, NamesRobotsInQuarantineAndThoseThatContradictTheFleet) {
  EXPECT_THAT(printed(), Not(HasSubstr("quarantine")));
  output::Results& results = *outcome_.agents[0].results;
  results.placement.alignment_stats[testing::agent("r3")] = {0, 6, 2, true};
  results.placement.alignment_stats[testing::agent("r4")] = {6, 1, 0, false};
  results.contradicting[testing::agent("r5")] = {9, {testing::agent("r1"), testing::agent("r2")}, 0, 0};
  EXPECT_THAT(printed(), HasSubstr("r3 is in quarantine: 2 alignments that it computed are false"));
  EXPECT_THAT(printed(), Not(HasSubstr("r4")));
  EXPECT_THAT(printed(), HasSubstr("r5 contradicts the fleet: 9 alignments with r1, r2 are rejected"));
}

TEST_F(RunSummary, SaysWhenTheExchangeOrTheMissionDidNotEnd) {
  EXPECT_THAT(printed(), HasSubstr("the exchange did not come to its end within exchange_timeout"));
  outcome_.exchange_ended = true;
  EXPECT_THAT(printed(), Not(HasSubstr("exchange_timeout")));
  EXPECT_THAT(printed(), Not(HasSubstr("mission")));
  Completion& completion = outcome_.completion.emplace();
  completion.why_not = "r2 is not joined";
  completion.abandoned = {{7, testing::agent("r1"), ""}};
  EXPECT_THAT(printed(), HasSubstr("row 7 was given up by r1: no robot was left to drive it\n"));
  EXPECT_THAT(printed(), HasSubstr("mission not completed: r2 is not joined\n"));
  completion.completed = 300.0;
  EXPECT_THAT(printed(), HasSubstr("mission completed after 300 s\n"));
  EXPECT_THAT(printed(), HasSubstr("report: out/report.html\n"));
}

}  // namespace
}  // namespace fleetmap::apps
