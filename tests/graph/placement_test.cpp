#include "fleetmap/graph/placement.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace fleetmap::graph {
namespace {

TEST(AlignmentStatus, EachHasAWordOfItsOwn) {
  std::set<std::string> words;
  for (int k = 0; k <= static_cast<int>(AlignmentStatus::invalid); ++k)
    words.insert(to_string(static_cast<AlignmentStatus>(k)));
  // Tables of alignments have these words.
  EXPECT_EQ(words, (std::set<std::string>{"used", "against GPS", "against others", "undecided", "quarantined",
                                          "waiting", "invalid"}));
  EXPECT_STREQ(to_string(AlignmentStatus::used), "used");
  EXPECT_STREQ(to_string(AlignmentStatus::waiting), "waiting");
}

}  // namespace
}  // namespace fleetmap::graph
