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

constexpr const char* kHeader = "target,source,verdict,rmse_m,inlier_fraction,overlap,cpu_s,reason\n";

TEST(Attempt, node_names_come_back_as_they_were_written) {
  for (const NodeId& id :
       {NodeId{agent("r1"), 0}, NodeId{agent("r10"), 65'535}, NodeId{agent("a-b_c"), first_seq(4711) + 17},
        NodeId{agent("r1"), first_seq(65'534)}}) {
    const auto parsed = parse_node(to_string(id));
    ASSERT_TRUE(parsed) << to_string(id);
    EXPECT_EQ(*parsed, id);
  }
  for (const char* wrong :
       {"", "r1", "r1/", "/3", "r1/-1", "r1/65536", "r1#/3", "r1#65536/3", "R 1/3", "r1/3x", "r1#2#3/4"})
    EXPECT_FALSE(parse_node(wrong)) << wrong;
}

TEST(Attempt, lines_of_a_log_are_read_with_the_commas_of_their_reasons) {
  const auto read =
      parse_attempts(std::string(kHeader) +
                         "r1/0,r3/1,accepted,0.0757,0.70,0.98,0.0165,\"\"\n"
                         "r1#7/2,r2/4,rejected,0.13,0.28,0.83,0.01,\"only 0.28, at least \"0.45\"\"\n"
                         "r1/5,r2/5,failed,,,,0.5,\"no cloud\"\n",
                     agent("r1"));
  EXPECT_EQ(read.damaged, 0u);
  ASSERT_EQ(read.attempts.size(), 3u);
  EXPECT_EQ(read.attempts[0].source, testing::node_id("r3", 1));
  EXPECT_EQ(read.attempts[0].overlap, 0.98);
  EXPECT_EQ(read.attempts[1].target, testing::node_id("r1", first_seq(7) + 2));
  EXPECT_EQ(read.attempts[1].reason, "only 0.28, at least \"0.45\"");
  EXPECT_EQ(read.attempts[2].verdict, "failed");
  EXPECT_EQ(read.attempts[2].rmse_m, std::nullopt);
}

TEST(Attempt, damaged_lines_are_counted_and_left_out) {
  const auto read = parse_attempts(std::string(kHeader) +
                                       "r1/0,r3/1,accepted,0.0757,0.70,0.98,0.0165,\"\"\n"
                                       "r1/0,r3/1,perhaps,0.0757,0.70,0.98,0.0165,\"\"\n"
                                       "r1/0,accepted\n"
                                       "nowhere,r3/1,accepted,0.0757,0.70,0.98,0.0165,\"\"\n"
                                       "r1/0,r3/1,accepted,0.0757,0.70,0.98,0.0165,\"cut o",
                                   agent("r1"));
  EXPECT_EQ(read.attempts.size(), 1u);
  EXPECT_EQ(read.damaged, 4u);
  EXPECT_TRUE(parse_attempts("", agent("r1")).attempts.empty());
  const auto odd =
      parse_attempts(std::string(kHeader) + "r1/0,r3/1,accepted,nan,x,inf,0,\"\"\n", agent("r1"));
  ASSERT_EQ(odd.attempts.size(), 1u);
  EXPECT_EQ(odd.attempts[0].rmse_m, std::nullopt);
  EXPECT_EQ(odd.attempts[0].inlier_fraction, std::nullopt);
  EXPECT_EQ(odd.attempts[0].overlap, std::nullopt);
}

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
