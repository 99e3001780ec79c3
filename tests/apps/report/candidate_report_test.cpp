#include "report/candidate_report.hpp"

#include <gmock/gmock.h>

#include "support/robots.hpp"

namespace fleetmap::apps {
namespace {

using fleetmap::testing::kPeer;
using fleetmap::testing::kSelf;
using monitor::PairCandidates;
using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

PairCandidates counted(const AgentId& by, const AgentId& with) {
  PairCandidates one;
  one.by = by;
  one.with = with;
  one.waiting = 1;
  one.requested = 2;
  one.registering = 3;
  one.aligned = 4;
  one.rejected = 5;
  one.not_received = 6;
  one.to_be_retried = 7;
  one.redundant = 8;
  one.overflowed = 9;
  one.uninformative = 10;
  return one;
}

std::vector<PairCandidates> read(const std::string& text) {
  return reported_candidates(json::parse(text, nullptr, false), kSelf);
}

TEST(CandidateReport, ReportsOfOneRobotAndOfARunAreReadAsOfTheirEnd) {
  PairCandidates ours = counted(kSelf, kPeer), theirs = counted(kPeer, kSelf);
  const json of_one{{"candidates_with", candidates_json({ours})}};
  const json of_run{
      {"agents", {{kSelf.str(), of_one}, {kPeer.str(), {{"candidates_with", candidates_json({theirs})}}}}}};
  ours.ended = theirs.ended = true;
  EXPECT_THAT(read(of_one.dump()), ElementsAre(ours));
  EXPECT_THAT(read(of_run.dump()), ::testing::UnorderedElementsAre(ours, theirs));
}

TEST(CandidateReport, WhatIsNoSuchReportHasNone) {
  for (const char* text :
       {"", "[1]", "{\"agents\": 3}", "{\"agents\": {\"r2\": 1}}", "{\"candidates_with\": [1]}",
        "{\"candidates_with\": {\"no name\": {}, \"r2\": 5}}",
        "{\"agents\": {\"r2\": {\"switched_off\": true}}}"})
    EXPECT_THAT(read(text), IsEmpty()) << text;
  const auto odd =
      read("{\"candidates_with\": {\"r9\": {\"waiting\": -1, \"aligned\": \"x\", \"rejected\": 2}}}");
  ASSERT_EQ(odd.size(), 1u);
  EXPECT_EQ(odd[0].waiting + odd[0].aligned, 0u);
  EXPECT_EQ(odd[0].rejected, 2u);
}

}  // namespace
}  // namespace fleetmap::apps
