#include "fleetmap/monitor/attempt.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "monitor/views.hpp"
#include "store/items.hpp"

namespace fleetmap::monitor {
namespace {

using testing::agent;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(Attempt, a_sentence_tells_who_what_and_why) {
  const Attempt rejected{agent("r2"),
                         testing::node_id("r1", 3),
                         testing::node_id("r2", 4),
                         "rejected",
                         0.13,
                         0.28,
                         0.83,
                         "only 120 inliers, at least 200 are needed"};
  EXPECT_EQ(sentence(rejected, std::nullopt),
            "r2 registered r2/4 onto r1/3: rejected, because only 120 inliers, at least 200 are needed. 83 % "
            "of the cloud overlaps, 28 % are inliers, the inlier RMSE is 0.13 m.");
  Attempt accepted = rejected;
  accepted.verdict = "accepted";
  accepted.reason.clear();
  EXPECT_THAT(sentence(accepted, graph::AlignmentStatus::against_gps),
              AllOf(Not(HasSubstr("because")),
                    HasSubstr("; the graph does not use it: it contradicts GPS and odometry.")));
  EXPECT_THAT(sentence(accepted, graph::AlignmentStatus::used), HasSubstr("; the graph uses it."));
  accepted.overlap = accepted.inlier_fraction = std::nullopt;
  EXPECT_EQ(sentence(accepted, graph::AlignmentStatus::used),
            "r2 registered r2/4 onto r1/3: accepted. The inlier RMSE is 0.13 m; the graph uses it.");
}

TEST(Attempt, an_RMSE_that_is_the_reason_is_not_repeated) {
  const Attempt rejected{agent("r2"),
                         testing::node_id("r1", 3),
                         testing::node_id("r2", 4),
                         "rejected",
                         0.077,
                         0.76,
                         0.97,
                         "inlier RMSE is 0.08 m, at most 0.05 m is good"};
  EXPECT_EQ(sentence(rejected, std::nullopt),
            "r2 registered r2/4 onto r1/3: rejected, because inlier RMSE is 0.08 m, at most 0.05 m is good. "
            "97 % of the cloud overlaps, 76 % are inliers.");
}

}  // namespace
}  // namespace fleetmap::monitor
