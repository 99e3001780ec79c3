#include "maps/merge_summary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

namespace fleetmap::apps {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

MergedStore two_days() {
  MergedStore merged;
  merged.unions.resize(2);
  merged.unions[0].nodes = 7;
  merged.unions[1].submaps = 5;
  DayPair& pair = merged.pairs.emplace_back();
  pair.later = 1;
  pair.joined = true;
  pair.used = 3;
  pair.alignments.candidates = 9;
  pair.alignments.accepted = 4;
  pair.alignments.ambiguous = 1;
  pair.alignments.rejected = {{"too few inliers", 3}, {"ambiguous along the rows", 1}};
  return merged;
}

std::string summary_of(const MergedStore& merged, bool verbose = false) {
  std::ostringstream out;
  print_summary(out, merged, {"a.db", "b.db"}, "out/store.db", verbose);
  return out.str();
}

TEST(MergeSummary, NamesWhatEachStoreAddedAndWhatJoinsThem) {
  EXPECT_THAT(summary_of(two_days()),
              AllOf(HasSubstr("a.db: 7 nodes, 0 submaps, "), HasSubstr("b.db: 0 nodes, 5 submaps, "),
                    HasSubstr("a.db and b.db: joined by 3 alignments (9 candidates: 4 accepted, 1 ambiguous, "
                              "4 rejected)\n"),
                    HasSubstr("  rejected 3 times: too few inliers\n"), HasSubstr("out/store.db: 0 nodes, "),
                    Not(HasSubstr("left out"))));
}

TEST(MergeSummary, ThatTwoDaysAreNotJoinedHasItsReason) {
  MergedStore merged = two_days();
  merged.pairs[0].joined = false;
  merged.pairs[0].why_not = "they do not overlap";
  EXPECT_THAT(summary_of(merged),
              HasSubstr("a.db and b.db: NOT joined: they do not overlap (9 candidates: "));
  merged.pairs[0].joined = merged.pairs[0].frames_shared = true;
  EXPECT_THAT(summary_of(merged), HasSubstr("joined by 3 alignments and the sessions that both have ("));
}

TEST(MergeSummary, RejectionsAreSummedUnlessAllAreAskedFor) {
  MergedStore merged = two_days();
  merged.pairs[0].alignments.rejected = {{"only 12 inliers", 1}, {"only 15 inliers", 2}, {"no prior", 1}};
  EXPECT_THAT(summary_of(merged), AllOf(HasSubstr("4 rejected)\n  rejected 3 times: only 12 to 15 inliers\n"
                                                  "  rejected 1 times: no prior\n"),
                                        Not(HasSubstr("only 12 inliers"))));
  EXPECT_THAT(summary_of(merged, true), AllOf(HasSubstr("  rejected 1 times: only 12 inliers\n"),
                                              HasSubstr("  rejected 2 times: only 15 inliers\n")));
}

TEST(MergeSummary, TellsWhatIsLeftOutAndListsContestedNamesUpToTwenty) {
  MergedStore merged = two_days();
  merged.unions[1].unproven = 2;
  merged.unions[1].unreadable = 1;
  for (int k = 0; k < 25; ++k) merged.unions[1].contested.push_back("node r1/" + std::to_string(k));
  EXPECT_THAT(summary_of(merged),
              AllOf(HasSubstr("b.db: 2 items left out"), HasSubstr("b.db: 1 submaps are damaged"),
                    HasSubstr("b.db: node r1/19 has two contents"), Not(HasSubstr("node r1/20 ")),
                    HasSubstr("b.db: and 5 more names\n"), HasSubstr("--first-session 1000")));
}

}  // namespace
}  // namespace fleetmap::apps
