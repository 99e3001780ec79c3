#include "loop_closure_sections.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "section_problems.hpp"

namespace fleetmap::config {
namespace {

using ::testing::HasSubstr;

struct LoopClosureReading {
  loop_closure::CandidateConfig closure;
  loop_closure::OwnPathConfig own_path;
  std::string problems;
};

LoopClosureReading loop_closure_of(const std::string& yaml) {
  LoopClosureReading result;
  result.problems = problems_of(yaml, [&](Section& top) {
    read_own_path(top, result.own_path);
    read_loop_candidates(top, result.closure);
  });
  return result;
}

TEST(LoopClosureSections, ReadsTheOwnPath) {
  const LoopClosureReading r = loop_closure_of("own_path: {reach: 30, min_path: 70, spacing: 12}\n");
  EXPECT_EQ(r.problems, "");
  EXPECT_EQ(r.own_path.reach, 30.0);
  EXPECT_EQ(r.own_path.min_path, 70.0);
  EXPECT_EQ(r.own_path.spacing, 12.0);
}

TEST(LoopClosureSections, ReadsProximityAndLoopCandidates) {
  const LoopClosureReading r = loop_closure_of(
      "proximity: {uncertainty: variance, radius_scale: 4, min_radius: 5, max_radius: 50}\n"
      "loop_candidates: {spacing: 1, spacing_aligned: 2, spacing_failed: 3, min_nodes_after: 4, max_wait: "
      "5.5,\n"
      "  retry_after: 6, max_attempts: 7, stop_when_peer_aligned: true, order: first_come, min_information: "
      "0.8}\n");
  EXPECT_EQ(r.problems, "");
  EXPECT_EQ(r.closure.proximity.uncertainty, place::Uncertainty::variance);
  EXPECT_EQ(r.closure.proximity.radius_scale, 4.0);
  EXPECT_EQ(r.closure.proximity.min_radius, 5.0);
  EXPECT_EQ(r.closure.proximity.max_radius, 50.0);
  EXPECT_EQ(r.closure.spacing_m, 1.0);
  EXPECT_EQ(r.closure.spacing_aligned_m, 2.0);
  EXPECT_EQ(r.closure.spacing_failed_m, 3.0);
  EXPECT_EQ(r.closure.min_nodes_after, 4u);
  EXPECT_EQ(r.closure.max_wait, std::chrono::milliseconds(5500));
  EXPECT_EQ(r.closure.retry_after, std::chrono::seconds(6));
  EXPECT_EQ(r.closure.max_attempts, 7);
  EXPECT_TRUE(r.closure.stop_when_peer_aligned);
  EXPECT_EQ(r.closure.order, exchange::CloudOrder::kFirstCome);
  EXPECT_EQ(r.closure.min_information, 0.8);
}

TEST(LoopClosureSections, WithoutKeysBothEndsRegisterThoseWithMostInformationFirst) {
  const LoopClosureReading r = loop_closure_of("{}");
  EXPECT_EQ(r.problems, "");
  EXPECT_FALSE(r.closure.stop_when_peer_aligned) << "as the paper's robots do";
  EXPECT_EQ(r.closure.order, exchange::CloudOrder::kInformation);
  EXPECT_EQ(r.closure.proximity.uncertainty, place::Uncertainty::sigma);
  EXPECT_EQ(r.closure.spacing_m, loop_closure::CandidateConfig{}.spacing_m);
}

TEST(LoopClosureSections, ProblemsNameTheKeyAndItsLine) {
  EXPECT_THAT(
      loop_closure_of("proximity:\n  uncertainty: covariance\n").problems,
      HasSubstr("robot.yaml:2: proximity.uncertainty: expected 'sigma' or 'variance', found 'covariance'"));
  EXPECT_THAT(
      loop_closure_of("loop_candidates:\n  order: best\n").problems,
      HasSubstr("robot.yaml:2: loop_candidates.order: expected 'information' or 'first_come', found 'best'"));
  EXPECT_THAT(loop_closure_of("loop_candidates:\n  min_information: -1\n").problems,
              HasSubstr("robot.yaml:2: loop_candidates.min_information: "));
  EXPECT_THAT(loop_closure_of("loop_candidates:\n  spacing: -1\n").problems, HasSubstr("loop_candidates"));
  EXPECT_THAT(loop_closure_of("own_path:\n  min_path: 10\n").problems,
              HasSubstr("robot.yaml:2: own_path.min_path: "));
  EXPECT_THAT(loop_closure_of("own_path: {distance: 10}\n").problems,
              HasSubstr("known here: min_path reach spacing"));
}

}  // namespace
}  // namespace fleetmap::config
