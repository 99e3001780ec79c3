#include "fleetmap/core/edit_distance.hpp"

#include <gtest/gtest.h>

namespace fleetmap {
namespace {

TEST(EditDistance, CountsWhatIsInsertedRemovedAndReplaced) {
  EXPECT_EQ(edit_distance("lane", "lane"), 0u);
  EXPECT_EQ(edit_distance("lane", "lanes"), 1u);
  EXPECT_EQ(edit_distance("lane", "line"), 1u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
}

TEST(EditDistance, AWordMayBeMisspeltInAThirdOfItsCharacters) {
  EXPECT_TRUE(may_be_misspelt("los", "loss"));
  EXPECT_TRUE(may_be_misspelt("modle", "model"));
  EXPECT_TRUE(may_be_misspelt("wheel", "wheels"));
  EXPECT_FALSE(may_be_misspelt("nope", "mode")) << "half of it differs";
  EXPECT_FALSE(may_be_misspelt("x", "y"));
  EXPECT_FALSE(may_be_misspelt("id", ""));
}

TEST(EditDistance, IsSymmetricAndObeysTheTriangleInequality) {
  const char* words[] = {"seed=01", "seed=10", "agents=2.seed=01", "", "rate"};
  for (const char* a : words) {
    for (const char* b : words) {
      EXPECT_EQ(edit_distance(a, b), edit_distance(b, a));
      for (const char* c : words) EXPECT_LE(edit_distance(a, c), edit_distance(a, b) + edit_distance(b, c));
    }
  }
}

}  // namespace
}  // namespace fleetmap
