#include "candidate_set.hpp"

#include <gtest/gtest.h>

#include "loop_closure/two_robots.hpp"
#include "store/items.hpp"

namespace fleetmap::loop_closure {
namespace {

using testing::agent;

/// Nodes of a and of b every 2 m, the same places.
class CandidateSetTest : public ::testing::Test {
 protected:
  CandidateSetTest() {
    for (std::uint32_t seq = 0; seq < 60; ++seq) {
      for (const char* name : {"a", "b"}) {
        auto node = testing::make_node(agent(name), seq, Bytes{}, 2.0 * seq);
        node.G->covariance = 0.01 * Matrix6d::Identity();
        nodes_.add(node);
      }
    }
  }
  static LoopCandidate candidate(std::uint32_t ours, std::uint32_t theirs, double distance) {
    return {{agent("a"), ours}, {agent("b"), theirs}, LoopCandidate::Origin::kPosition, distance, 20.0};
  }
  static LoopCandidate match(std::uint32_t seq, double score) {
    return {{agent("a"), seq}, {agent("b"), seq}, LoopCandidate::Origin::kDescriptor, 1.0, 30.0, score};
  }

  CandidateConfig config_;
  NodeIndex nodes_{agent("a"), 15.0};
  CandidateSet set_{config_, nodes_};
};

TEST_F(CandidateSetTest, CandidatesKeepTheSpacingThatGrowsWithTheFirstGoodAlignment) {
  set_.offer(candidate(0, 0, 1.0), kStart);
  set_.offer(candidate(4, 4, 1.0), kStart);  // 8 m on
  EXPECT_EQ(set_.open().size(), 1u);
  EXPECT_EQ(set_.redundant_count(), 1u);
  EXPECT_EQ(set_.by_peer().at(agent("b")).redundant, 1u);
  EXPECT_EQ(set_.by_peer().at(agent("b")).waiting, 1u);
  set_.offer(candidate(6, 6, 1.0), kStart);
  EXPECT_EQ(set_.open().size(), 2u);
  set_.on_aligned(agent("b"));
  EXPECT_TRUE(set_.redundant(candidate(6, 6, 1.0).pair())) << "12 m, and now 20 m are due";
}

TEST_F(CandidateSetTest, ANearerPairTakesTheTurnOfOneThatWaits) {
  set_.offer(candidate(0, 3, 6.0), kStart);
  set_.offer(candidate(1, 2, 2.0), kStart + std::chrono::seconds(5));
  ASSERT_EQ(set_.open().size(), 1u);
  const auto& [pair, scheduled] = *set_.open().begin();
  EXPECT_EQ(pair, candidate(1, 2, 2.0).pair());
  EXPECT_EQ(scheduled.found, kStart);
  set_.at(pair).phase = CandidateSet::Phase::kRequested;
  set_.offer(candidate(2, 2, 0.0), kStart);
  EXPECT_TRUE(set_.contains(pair)) << "its cloud was requested";
}

TEST_F(CandidateSetTest, ABetterMatchReplacesAMatchAndNothingElse) {
  set_.offer(match(0, 0.6), kStart);
  set_.offer(match(1, 0.5), kStart);
  EXPECT_TRUE(set_.contains(match(0, 0.6).pair()));
  set_.offer(match(2, 0.7), kStart + std::chrono::seconds(1));
  ASSERT_EQ(set_.open().size(), 1u);
  EXPECT_EQ(set_.open().begin()->second.found, kStart + std::chrono::seconds(1));
  set_.offer(candidate(20, 20, 9.0), kStart);
  set_.offer(match(21, 1.9), kStart);
  EXPECT_TRUE(set_.contains(candidate(20, 20, 9.0).pair()));
}

TEST_F(CandidateSetTest, TheOldestGivesWayWhenTooManyWait) {
  config_.max_waiting = 2;
  for (std::uint32_t k = 0; k < 3; ++k) {
    EXPECT_EQ(set_.room(), 2u - std::min(k, 2u));
    set_.offer(candidate(10 * k, 10 * k, 1.0), kStart + std::chrono::seconds(10 - k));
  }
  EXPECT_EQ(set_.overflowed_count(), 1u);
  EXPECT_FALSE(set_.contains(candidate(20, 20, 1.0).pair()));
}

TEST_F(CandidateSetTest, APairWithAnUnknownNodeIsNotAdded) {
  set_.add(candidate(0, 1000, 1.0), kStart, true);
  EXPECT_TRUE(set_.open().empty());
}

TEST_F(CandidateSetTest, ADoneCandidateKeepsOthersAwayAndIsVisitedNoMore) {
  set_.offer(candidate(0, 0, 1.0), kStart);
  set_.conclude(candidate(0, 0, 1.0).pair());
  EXPECT_TRUE(set_.open().empty());
  EXPECT_TRUE(set_.contains(candidate(0, 0, 1.0).pair()));
  set_.offer(candidate(4, 4, 1.0), kStart);  // 8 m on
  EXPECT_TRUE(set_.open().empty());
  set_.offer(candidate(6, 6, 1.0), kStart);
  EXPECT_EQ(set_.open().size(), 1u);
}

TEST_F(CandidateSetTest, AFailedCandidateIsExhaustedAfterItsAttemptsOrBesideOneThatIsDone) {
  const auto fail = [&](std::uint32_t seq, int attempts) {
    set_.offer(candidate(seq, seq, 1.0), kStart);
    ScheduledCandidate& failed = set_.at(candidate(seq, seq, 1.0).pair());
    failed.phase = CandidateSet::Phase::kFailed;
    failed.attempts = attempts;
    return candidate(seq, seq, 1.0).pair();
  };
  const auto is_exhausted = [&](const NodePair& pair) { return set_.is_exhausted(pair, *set_.find(pair)); };
  EXPECT_TRUE(is_exhausted(fail(40, config_.max_attempts)));
  const NodePair once = fail(0, 1), neighbour = candidate(3, 3, 1.0).pair();  // 6 m on
  EXPECT_FALSE(is_exhausted(once));
  set_.offer(candidate(3, 3, 1.0), kStart);
  EXPECT_TRUE(set_.redundant(once));
  EXPECT_FALSE(is_exhausted(once)) << "the neighbour may yet fail";
  set_.conclude(neighbour);
  EXPECT_TRUE(is_exhausted(once));
}

TEST_F(CandidateSetTest, AnAbandonedOneKeepsOthersAwayAndIsVisitedNoMore) {
  set_.offer(candidate(0, 0, 1.0), kStart);
  const NodePair pair = candidate(0, 0, 1.0).pair();
  set_.at(pair).phase = CandidateSet::Phase::kFailed;
  set_.at(pair).attempts = config_.max_attempts;
  set_.abandon(pair);
  EXPECT_TRUE(set_.open().empty());
  EXPECT_TRUE(set_.contains(pair));
  set_.offer(candidate(2, 2, 1.0), kStart);  // 4 m on, and 5 m are due beside one that failed
  EXPECT_TRUE(set_.open().empty());
  set_.set_known_to_peer(pair.ours, agent("b"));
  EXPECT_TRUE(set_.find(pair)->known_to_peer);
  set_.conclude(pair);  // the peer had success
  EXPECT_EQ(set_.find(pair)->phase, CandidateSet::Phase::kDone);
}

/// As when the name of a node becomes contested.
TEST_F(CandidateSetTest, AnAbandonedOneIsBackOnceTheRedundancyIsGone) {
  const NodePair once = candidate(0, 0, 1.0).pair(), twice = candidate(2, 2, 1.0).pair(),
                 spent = candidate(30, 30, 1.0).pair();
  for (const NodePair& pair : {once, twice, spent}) {
    set_.add({pair.ours, pair.theirs, LoopCandidate::Origin::kPosition, 1.0, 20.0}, kStart, true);
    set_.at(pair).phase = CandidateSet::Phase::kFailed;
    set_.at(pair).attempts = pair == once ? 1 : config_.max_attempts;
  }
  for (const NodePair& pair : {twice, spent, once}) {
    EXPECT_TRUE(set_.is_exhausted(pair, set_.at(pair)));
    set_.abandon(pair);
  }
  set_.erase_if([&](const NodePair& pair, const ScheduledCandidate&) { return pair == twice; });
  EXPECT_FALSE(set_.contains(twice));
  ASSERT_EQ(set_.open().size(), 1u);
  EXPECT_TRUE(set_.retryable(once, set_.at(once)));
  set_.abandon(once);
  set_.on_removed_node();
  EXPECT_EQ(set_.open().size(), 1u) << "and not the one that had its attempts";
}

/// After a start alignments come before their nodes.
TEST(CandidateSetOrder, ACandidateIsFoundByItsPlaceOnceItsNodesAreThere) {
  CandidateConfig config;
  NodeIndex nodes(agent("a"), 15.0);
  CandidateSet set(config, nodes);
  const auto add = [&](const char* name, std::uint32_t seq, bool located) {
    auto node = testing::make_node(agent(name), seq, Bytes{}, 2.0 * seq);
    node.G->covariance = 0.01 * Matrix6d::Identity();
    node.T_odom_base.translation() = Eigen::Vector3d(2.0 * seq, 0.0, 0.0);
    if (!located) node.G.reset();
    nodes.add(node);
    set.on_node(node.id);
  };
  const auto pair = [](std::uint32_t seq) { return NodePair{{agent("a"), seq}, {agent("b"), seq}}; };
  set.find_or_make(pair(0));
  set.conclude(pair(0));
  for (const char* name : {"a", "b"}) {
    add(name, 0, true);
    add(name, 4, true);
    add(name, 5, false);
    add(name, 40, true);
  }
  EXPECT_TRUE(set.redundant(pair(4)));
  EXPECT_FALSE(set.redundant(pair(40)));
  // Without G by the odometry frames.
  set.find_or_make(pair(4));
  EXPECT_TRUE(set.redundant(pair(5)));
}

}  // namespace
}  // namespace fleetmap::loop_closure
