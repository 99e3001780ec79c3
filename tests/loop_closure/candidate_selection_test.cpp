#include "candidate_selection.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "loop_closure/two_robots.hpp"
#include "store/items.hpp"

namespace fleetmap::loop_closure {
namespace {

using Phase = ScheduledCandidate::Phase;

/// Nodes of a and of b every 2 m at the same positions, with a G of 0.1 m; the odometry of b is ten times
/// less certain beyond its 30th node.
class CandidateSelectionTest : public ::testing::Test {
 protected:
  CandidateSelectionTest() {
    for (std::uint32_t seq = 0; seq < 60; ++seq) {
      for (const AgentId& name : {kA, kB}) {
        auto node = testing::make_node(name, seq, Bytes{}, 2.0 * seq);
        node.G->covariance = 0.01 * Matrix6d::Identity();
        node.odom_covariance = (name == kB && seq > 30 ? 0.1 : 0.001) * Matrix6d::Identity();
        nodes_.add(node);
        selection_.information().add(node);
      }
    }
  }
  static NodePair pair(std::uint32_t seq) { return {{kA, seq}, {kB, seq}}; }
  void offer(std::uint32_t seq, Stamp now = kStart) {
    candidates_.offer({{kA, seq}, {kB, seq}, LoopCandidate::Origin::kPosition, 1.0, 20.0}, now);
  }
  std::vector<NodePair> ready(Stamp now, bool heard = true) {
    return selection_.ready([=](const AgentId&) { return heard; }, now);
  }

  CandidateConfig config_;
  NodeIndex nodes_{kA, 15.0};
  CandidateSet candidates_{config_, nodes_};
  CandidateSelection selection_{config_, nodes_, candidates_};
};

TEST_F(CandidateSelectionTest, ACandidateIsReadyOnceBothCloudsAreCompleteOrItHasWaitedLongEnough) {
  offer(56);  // three nodes follow
  offer(40);
  EXPECT_EQ(ready(kStart), (std::vector{pair(40), pair(56)}));
  EXPECT_TRUE(ready(kStart, false).empty()) << "the other robot is not heard";
  config_.min_nodes_after = 4;
  EXPECT_EQ(ready(kStart), std::vector{pair(40)});
  EXPECT_EQ(ready(kStart + config_.max_wait).size(), 2u);
}

TEST_F(CandidateSelectionTest, AFailedCandidateIsReadyAgainOnceAndNotBeforeItsTime) {
  offer(10);
  ScheduledCandidate& failed = candidates_.at(pair(10));
  failed.phase = Phase::kFailed;
  failed.attempts = 1;
  failed.retry_at = kStart + std::chrono::seconds(60);
  EXPECT_TRUE(ready(kStart + std::chrono::seconds(59)).empty());
  EXPECT_EQ(ready(kStart + std::chrono::seconds(60)), std::vector{pair(10)});
  failed.attempts = config_.max_attempts;
  EXPECT_TRUE(ready(kStart + std::chrono::seconds(60)).empty());
}

/// Those of a long day would be visited 50 times a second.
TEST_F(CandidateSelectionTest, CandidatesThatFailedForGoodAreVisitedNoMore) {
  for (const std::uint32_t seq : {10u, 20u, 30u}) {
    offer(seq);
    candidates_.at(pair(seq)).phase = Phase::kFailed;
    candidates_.at(pair(seq)).attempts = seq == 20 ? 1 : config_.max_attempts;
  }
  EXPECT_EQ(ready(kStart), std::vector{pair(20)});
  EXPECT_EQ(candidates_.open().size(), 1u);
  EXPECT_EQ(ready(kStart), std::vector{pair(20)});
}

TEST_F(CandidateSelectionTest, CandidatesThatBecameRedundantAreDroppedAndOneOfTwoStays) {
  offer(10);
  offer(16);  // 12 m apart, and 20 m are required after the first good alignment
  candidates_.on_aligned(kB);
  EXPECT_EQ(ready(kStart).size(), 1u);
  EXPECT_EQ(candidates_.open().size(), 1u);
}

TEST_F(CandidateSelectionTest, TheCandidateWithTheMostInformationIsNext) {
  offer(5);
  offer(50);
  std::vector<NodePair> waiting = ready(kStart);
  const auto first = selection_.next(waiting, true);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->pair, pair(50)) << "its odometry is less certain";
  EXPECT_EQ(waiting, std::vector{pair(5)});
  const auto second = selection_.next(waiting, true);
  ASSERT_TRUE(second);
  EXPECT_LT(second->information, first->information);
  EXPECT_TRUE(waiting.empty());
  EXPECT_FALSE(selection_.next(waiting, true));
}

TEST_F(CandidateSelectionTest, InOrderOfArrivalTheOldestIsNext) {
  config_.order = exchange::CloudOrder::kFirstCome;
  offer(50, kStart + std::chrono::seconds(1));
  offer(5);
  std::vector<NodePair> waiting = ready(kStart + std::chrono::seconds(1));
  EXPECT_EQ(selection_.next(waiting, true)->pair, pair(5));
}

TEST_F(CandidateSelectionTest, UninformativeCandidatesAreDroppedUnlessTheRadioHasRoom) {
  config_.min_information = 100.0;
  offer(5);
  std::vector<NodePair> waiting = ready(kStart);
  EXPECT_FALSE(selection_.next(waiting, false));
  EXPECT_EQ(selection_.uninformative_count(), 1u);
  EXPECT_EQ(candidates_.by_peer().begin()->second.uninformative, 1u);
  EXPECT_FALSE(candidates_.contains(pair(5)));
  offer(5);
  waiting = ready(kStart);
  EXPECT_TRUE(selection_.next(waiting, true));
}

}  // namespace
}  // namespace fleetmap::loop_closure
