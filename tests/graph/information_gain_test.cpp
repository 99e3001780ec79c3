#include "fleetmap/graph/information_gain.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <random>

namespace fleetmap::graph {
namespace {

const AgentId kA = AgentId::parse("a").value();
const AgentId kB = AgentId::parse("b").value();
const AgentId kC = AgentId::parse("c").value();

constexpr double kStep = 1e-5;  // variance of each axis, [m^2, rad^2]
/// m^2: mean square displacement of a point 10 m away.
constexpr double scalar(double variance) { return 3.0 * variance + 3.0 * 100.0 * variance; }
constexpr double kExpectedVariance = 1.5e-3;

Node node(const AgentId& agent, std::uint32_t seq, std::optional<double> gps_sigma = std::nullopt,
          std::uint16_t session = 0) {
  Node node;
  node.id = {agent, seq};
  node.session = session;
  node.odom_covariance = kStep * Matrix6d::Identity();
  if (gps_sigma) {
    node.G.emplace();
    node.G->covariance = Matrix6d::Zero();
    node.G->covariance.diagonal().head<2>().setConstant(0.5 * *gps_sigma * *gps_sigma);
  }
  return node;
}

Alignment alignment(const NodeId& i, const NodeId& j, double variance = kStep) {
  Alignment alignment;
  alignment.i = i;
  alignment.j = j;
  alignment.modes.front().covariance = variance * Matrix6d::Identity();
  return alignment;
}

double gain_of(const InformationGain& gain_of, const NodeId& i, const NodeId& j,
               const std::vector<InformationGain::Pair>& expected = {}) {
  const InformationGain::Pair pair{i, j};
  return gain_of.of(std::span(&pair, 1), expected).front();
}

double of_variance(double variance) { return 0.5 * std::log1p(variance / kExpectedVariance); }

TEST(InformationGain, IsThatOfTheWayBetweenTheTwo) {
  InformationGain graph;
  for (std::uint32_t seq = 0; seq < 20; ++seq) {
    graph.add(node(kA, seq));
    graph.add(node(kB, seq));
  }
  graph.add(alignment({kA, 3}, {kB, 4}));
  // Seven steps of a, the alignment, six of b.
  EXPECT_NEAR(gain_of(graph, {kA, 10}, {kB, 10}), of_variance(14 * scalar(kStep)), 1e-4);
  EXPECT_NEAR(gain_of(graph, {kB, 10}, {kA, 10}), gain_of(graph, {kA, 10}, {kB, 10}), 1e-9);
  EXPECT_NEAR(gain_of(graph, {kA, 3}, {kB, 4}), of_variance(scalar(kStep)), 1e-4) << "the same once more";
}

TEST(InformationGain, TwoWaysLeaveLessOpenThanEither) {
  InformationGain graph;
  for (std::uint32_t seq = 0; seq <= 20; ++seq) {
    graph.add(node(kA, seq));
    graph.add(node(kB, seq));
  }
  graph.use(std::vector{alignment({kA, 0}, {kB, 0}), alignment({kA, 20}, {kB, 20})});
  // Each way 10 steps, an alignment and 10 steps; half of that side by side.
  EXPECT_NEAR(gain_of(graph, {kA, 10}, {kB, 10}), of_variance(21.0 / 2.0 * scalar(kStep)), 1e-4);
  EXPECT_LT(gain_of(graph, {kA, 19}, {kB, 19}), gain_of(graph, {kA, 10}, {kB, 10}));
  const double before = gain_of(graph, {kA, 11}, {kB, 11});
  const double after = gain_of(graph, {kA, 11}, {kB, 11}, {{{kA, 10}, {kB, 10}}});
  EXPECT_LT(after, 0.7 * before) << "what is asked for already counts";
  graph.use({});
  EXPECT_GT(gain_of(graph, {kA, 10}, {kB, 10}), 9.0) << "nothing is known";
}

TEST(InformationGain, GoesThroughThirdRobotsAndGps) {
  InformationGain graph;
  for (const AgentId& agent : {kA, kB, kC}) {
    for (std::uint32_t seq = 0; seq < 5; ++seq)
      graph.add(node(agent, seq, agent == kC ? std::nullopt : std::optional(seq == 2 ? 1.0 : 3.0)));
  }
  // Only the best fix of each track counts, because errors of GPS last for minutes.
  EXPECT_NEAR(gain_of(graph, {kA, 2}, {kB, 2}), of_variance(2.0), 1e-3);
  EXPECT_GT(gain_of(graph, {kA, 2}, {kC, 2}), 9.0);
  graph.add(alignment({kA, 2}, {kC, 2}));
  graph.add(alignment({kB, 2}, {kC, 2}));
  const double through_c = 2 * scalar(kStep), by_gps = 2.0;
  EXPECT_NEAR(gain_of(graph, {kA, 2}, {kB, 2}), of_variance(1.0 / (1.0 / through_c + 1.0 / by_gps)), 1e-4);
}

TEST(InformationGain, SessionsOfARobotAreTracksOfTheirOwnAndLostNodesCountAsTheNextOne) {
  InformationGain graph;
  graph.add(node(kA, 0));
  graph.add(node(kA, 1, {}, 1));
  EXPECT_GT(gain_of(graph, {kA, 0}, {kA, 1}), 9.0);
  graph.add(node(kB, 0));
  graph.add(node(kB, 4));
  EXPECT_NEAR(gain_of(graph, {kB, 0}, {kB, 4}), of_variance(4 * scalar(kStep)), 1e-4);
}

TEST(InformationGain, UnknownAmbiguousAndAbsurdAlignmentsGainNothing) {
  InformationGain graph;
  graph.add(node(kA, 0));
  graph.add(node(kB, 0));
  EXPECT_EQ(gain_of(graph, {kA, 0}, {kC, 7}), 0.0);
  EXPECT_EQ(gain_of(graph, {kA, 0}, {kA, 0}), 0.0);
  Alignment two = alignment({kA, 0}, {kB, 0});
  two.modes.resize(2);
  graph.add(two);
  graph.add(alignment({kA, 0}, {kC, 7}));
  graph.add(alignment({kA, 0}, {kB, 0}, std::nan("")));
  EXPECT_GT(gain_of(graph, {kA, 0}, {kB, 0}), 9.0);
}

/// Three robots on the same way, and the conductances between all of their nodes at once.
class WholeNetwork : public ::testing::Test {
 protected:
  static constexpr std::uint32_t kNodes = 150;  // of each

  void SetUp() override {
    std::vector<NodeId> order;
    for (const AgentId& agent : {kA, kB, kC}) {
      for (std::uint32_t seq = 0; seq < kNodes; ++seq) order.push_back({agent, seq});
    }
    laplacian_ = 1e-9 * Eigen::MatrixXd::Identity(3 * kNodes, 3 * kNodes);
    for (const NodeId& id : order) {
      Node made =
          node(id.agent, id.seq, id.seq % 50 == 20 ? std::optional(1.0 + 0.1 * id.seq) : std::nullopt);
      made.odom_covariance *= 1.0 + below(10);
      nodes_.push_back(made);
      if (id.seq > 0) connect({id.agent, id.seq - 1}, id, scalar(made.odom_covariance(0, 0)));
      if (id.seq == 20) laplacian_(index(id), index(id)) += 1.0 / std::pow(1.0 + 0.1 * 20, 2);
    }
    for (std::uint32_t seq = 0; seq < kNodes; seq += 1 + below(5)) {
      align({kA, seq}, {kB, std::min(kNodes - 1, seq + below(4))});
      if (seq > 90) align({kB, seq}, {kC, kNodes - seq});
    }
  }
  static Eigen::Index index(const NodeId& id) {
    return (id.agent == kA ? 0 : id.agent == kB ? 1 : 2) * kNodes + id.seq;
  }
  void connect(const NodeId& a, const NodeId& b, double variance) {
    const Eigen::Index i = index(a), j = index(b);
    laplacian_(i, i) += 1.0 / variance;
    laplacian_(j, j) += 1.0 / variance;
    laplacian_(i, j) -= 1.0 / variance;
    laplacian_(j, i) -= 1.0 / variance;
  }
  void align(const NodeId& a, const NodeId& b) {
    alignments_.push_back(alignment(a, b, 1e-6 * (1 + below(100))));
    connect(a, b, scalar(alignments_.back().best().covariance(0, 0)));
  }
  NodeId any(const AgentId& agent) { return {agent, below(kNodes)}; }
  std::uint32_t below(std::uint32_t end) { return static_cast<std::uint32_t>(random_() % end); }

  std::mt19937 random_{1};
  std::vector<Node> nodes_;
  std::vector<Alignment> alignments_;
  Eigen::MatrixXd laplacian_;
};

TEST_F(WholeNetwork, GivesTheSameAsTheNeighbourhoods) {
  InformationGain graph;
  std::ranges::shuffle(nodes_, random_);  // as nodes come that got lost on the way
  for (const Node& node : nodes_) graph.add(node);
  graph.use(alignments_);
  std::vector<InformationGain::Pair> pairs, expected;
  for (int k = 0; k < 100; ++k) {
    pairs.emplace_back(any(kA), any(kB));
    pairs.emplace_back(any(kB), any(kC));
    pairs.emplace_back(any(kA), any(kA));
  }
  expected = {{{kA, 40}, {kC, 70}}, {{kB, 3}, {kC, 1}}};
  for (const auto& pair : expected) {
    connect(pair.first, pair.second, kExpectedVariance);
  }
  const Eigen::LDLT<Eigen::MatrixXd> whole(laplacian_);
  const auto gains = graph.of(pairs, expected);
  double min = 100.0, max = 0.0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    Eigen::VectorXd current = Eigen::VectorXd::Zero(laplacian_.rows());
    current[index(pairs[k].first)] += 1.0;
    current[index(pairs[k].second)] -= 1.0;
    EXPECT_NEAR(gains[k], of_variance(current.dot(whole.solve(current))), InformationGain::kTolerance)
        << to_string(pairs[k].first) << " and " << to_string(pairs[k].second);
    min = std::min(min, gains[k]);
    max = std::max(max, gains[k]);
  }
  EXPECT_LT(min, 1.5);
  EXPECT_GT(max, 2.5) << "near and far ones were compared";
}

/// Two long tracks that are not aligned: no neighbourhood of a few nodes decides.
TEST(InformationGain, GainBetweenUnalignedTracksIsLargeForAnyLength) {
  InformationGain graph;
  for (std::uint32_t seq = 0; seq < 3000; ++seq) {
    for (const AgentId& agent : {kA, kB, kC}) graph.add(node(agent, seq));
    graph.add(alignment({kA, seq}, {kB, seq}));
  }
  const std::vector<InformationGain::Pair> pairs{{{kA, 2900}, {kC, 2900}}, {{kA, 100}, {kB, 101}}};
  const auto gains = graph.of(pairs, {});
  EXPECT_GT(gains[0], 5.0);
  EXPECT_LT(gains[1], 1.0);
  EXPECT_LT(gain_of(graph, {kA, 2900}, {kC, 2900}, {{{kA, 2890}, {kC, 2890}}}), 2.0);
}

}  // namespace
}  // namespace fleetmap::graph
