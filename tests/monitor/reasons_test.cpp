#include "fleetmap/monitor/reasons.hpp"

#include <gtest/gtest.h>

#include "monitor/views.hpp"
#include "store/items.hpp"

namespace fleetmap::monitor {
namespace {

using testing::node_id;
using testing::ViewMaker;

std::vector<Reason> reasons_of_texts(const std::vector<std::string>& texts) {
  ViewMaker fleet;
  for (const std::string& text : texts) fleet.attempt(node_id("r1", 0), node_id("r2", 0), "rejected", text);
  std::vector<const Attempt*> attempts;
  for (const Attempt& attempt : fleet.view.attempts) attempts.push_back(&attempt);
  return reasons_of(attempts);
}

TEST(Reasons, numbers_that_differ_become_a_range) {
  const auto reasons = reasons_of_texts({"inlier RMSE is 0.08 m, at most 0.05 m is good", "only 12 inliers",
                                         "inlier RMSE is 0.10 m, at most 0.05 m is good",
                                         "inlier RMSE is 0.06 m, at most 0.05 m is good"});
  ASSERT_EQ(reasons.size(), 2u);
  EXPECT_EQ(reasons[0].text, "inlier RMSE is 0.06 to 0.10 m, at most 0.05 m is good");
  EXPECT_EQ(reasons[0].count, 3u);
  EXPECT_EQ(reasons[1].text, "only 12 inliers");
}

TEST(Reasons, numbers_are_compared_by_value_and_a_full_stop_is_none) {
  const auto reasons = reasons_of_texts({"only 99 of 7.", "only 120 of 7."});
  ASSERT_EQ(reasons.size(), 1u);
  EXPECT_EQ(reasons[0].text, "only 99 to 120 of 7.");
}

TEST(Reasons, an_attempt_without_a_reason_has_its_verdict) {
  const auto reasons = reasons_of_texts({"", ""});
  ASSERT_EQ(reasons.size(), 1u);
  EXPECT_EQ(reasons[0].text, "rejected");
  EXPECT_EQ(reasons[0].count, 2u);
}

TEST(Reasons, counted_texts_add_up) {
  const auto reasons = reasons_of({{"only 12 inliers", 3}, {"only 15 inliers", 2}, {"no prior", 4}});
  ASSERT_EQ(reasons.size(), 2u);
  EXPECT_EQ(reasons[0].text, "only 12 to 15 inliers");
  EXPECT_EQ(reasons[0].count, 5u);
  EXPECT_EQ(reasons[1].count, 4u);
}

}  // namespace
}  // namespace fleetmap::monitor
