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
            "r2 registered r2/4 onto r1/3: rejected, because only 120 inliers, at least 200 are needed, 83 % "
            "of the "
            "cloud overlaps, 28 % are inliers, E 13.0 cm.");
  Attempt accepted = rejected;
  accepted.verdict = "accepted";
  accepted.reason.clear();
  EXPECT_THAT(sentence(accepted, graph::AlignmentStatus::against_gps),
              AllOf(Not(HasSubstr("because")),
                    HasSubstr("; the graph does not use it: it contradicts GPS and odometry.")));
  EXPECT_THAT(sentence(accepted, graph::AlignmentStatus::used), HasSubstr("; the graph uses it."));
}

}  // namespace
}  // namespace fleetmap::monitor
