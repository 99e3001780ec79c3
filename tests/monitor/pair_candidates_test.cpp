#include "fleetmap/monitor/pair_candidates.hpp"

#include <gtest/gtest.h>

#include "monitor/candidates_json.hpp"
#include "store/items.hpp"

namespace fleetmap::monitor {
namespace {

using testing::agent;

PairCandidates between(const char* by, const char* with) {
  PairCandidates all;
  all.by = agent(by);
  all.with = agent(with);
  return all;
}

TEST(PairCandidates, each_state_has_its_words) {
  PairCandidates all = between("r1", "r2");
  all.waiting = 3;
  all.requested = 1;
  all.registering = 2;
  all.aligned = 4;
  all.rejected = 5;
  all.not_received = 6;
  all.to_be_retried = 2;
  all.redundant = 57;
  all.overflowed = 1;
  all.uninformative = 8;
  EXPECT_EQ(
      sentence(all),
      "Candidates of r1 with r2: 4 are aligned; 2 are being registered; 5 were registered without an "
      "alignment; 3 wait for complete clouds or for a turn on the radio; 1 was requested, and the cloud is "
      "under way; 6 were not registered, since the cloud did not come; 8 were dropped, since the radio was "
      "busy and the alignment would have added too little; 1 was dropped, since too many waited; 57 were "
      "left out beside another one of the same place; 2 of those that failed will be tried again.");
}

TEST(PairCandidates, what_waits_waits_for_a_robot_that_is_not_heard) {
  PairCandidates all = between("r1", "r2");
  all.waiting = 1;
  all.heard = false;
  EXPECT_EQ(sentence(all), "Candidates of r1 with r2: 1 waits until r2 is heard again.");
}

TEST(PairCandidates, of_a_robot_that_ended_nothing_goes_on) {
  PairCandidates all = between("r1", "r2");
  all.ended = true;
  all.waiting = 1;
  all.requested = 2;
  all.not_received = 1;
  all.to_be_retried = 1;
  EXPECT_EQ(sentence(all),
            "Candidates of r1 with r2: 1 was still waiting at its end; 2 were requested, and the cloud had "
            "not come "
            "at its end; 1 was not registered, since the cloud did not come; 1 of those that failed would "
            "have been "
            "tried again.");
  EXPECT_EQ(sentence(between("r1", "r2")), "Candidates of r1 with r2: there is none any more.");
}

TEST(PairCandidates, the_page_gets_whose_they_are_and_the_sentence) {
  const auto json = candidates_json({between("r1", "r2"), between("r2", "r1")});
  ASSERT_EQ(json.size(), 2u);
  EXPECT_EQ(json[1]["by"], "r2");
  EXPECT_EQ(json[1]["with"], "r1");
  EXPECT_EQ(json[1]["sentence"], sentence(between("r2", "r1")));
}

}  // namespace
}  // namespace fleetmap::monitor
