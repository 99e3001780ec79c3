#include "fleetmap/graph/information_gain.hpp"

#include <gtest/gtest.h>

#include <cmath>

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

double worth(const InformationGain& worth, const NodeId& i, const NodeId& j,
             const std::vector<InformationGain::Pair>& expected = {}) {
  const InformationGain::Pair pair{i, j};
  return worth.of(std::span(&pair, 1), expected).front();
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
  EXPECT_NEAR(worth(graph, {kA, 10}, {kB, 10}), of_variance(14 * scalar(kStep)), 1e-4);
  EXPECT_NEAR(worth(graph, {kB, 10}, {kA, 10}), worth(graph, {kA, 10}, {kB, 10}), 1e-9);
  EXPECT_NEAR(worth(graph, {kA, 3}, {kB, 4}), of_variance(scalar(kStep)), 1e-4) << "the same once more";
}

TEST(InformationGain, TwoWaysLeaveLessOpenThanEither) {
  InformationGain graph;
  for (std::uint32_t seq = 0; seq <= 20; ++seq) {
    graph.add(node(kA, seq));
    graph.add(node(kB, seq));
  }
  graph.use(std::vector{alignment({kA, 0}, {kB, 0}), alignment({kA, 20}, {kB, 20})});
  // Each way 10 steps, an alignment and 10 steps; half of that side by side.
  EXPECT_NEAR(worth(graph, {kA, 10}, {kB, 10}), of_variance(21.0 / 2.0 * scalar(kStep)), 1e-4);
  EXPECT_LT(worth(graph, {kA, 19}, {kB, 19}), worth(graph, {kA, 10}, {kB, 10}));
  const double before = worth(graph, {kA, 11}, {kB, 11});
  const double after = worth(graph, {kA, 11}, {kB, 11}, {{{kA, 10}, {kB, 10}}});
  EXPECT_LT(after, 0.7 * before) << "what is asked for already counts";
  graph.use({});
  EXPECT_GT(worth(graph, {kA, 10}, {kB, 10}), 9.0) << "nothing is known";
}

TEST(InformationGain, GoesThroughThirdRobotsAndGps) {
  InformationGain graph;
  for (const AgentId& agent : {kA, kB, kC}) {
    for (std::uint32_t seq = 0; seq < 5; ++seq)
      graph.add(node(agent, seq, agent == kC ? std::nullopt : std::optional(seq == 2 ? 1.0 : 3.0)));
  }
  // Only the best fix of each track counts, because errors of GPS last for minutes.
  EXPECT_NEAR(worth(graph, {kA, 2}, {kB, 2}), of_variance(2.0), 1e-3);
  EXPECT_GT(worth(graph, {kA, 2}, {kC, 2}), 9.0);
  graph.add(alignment({kA, 2}, {kC, 2}));
  graph.add(alignment({kB, 2}, {kC, 2}));
  const double through_c = 2 * scalar(kStep), by_gps = 2.0;
  EXPECT_NEAR(worth(graph, {kA, 2}, {kB, 2}), of_variance(1.0 / (1.0 / through_c + 1.0 / by_gps)), 1e-4);
}

TEST(InformationGain, SessionsOfARobotAreTracksOfTheirOwnAndLostNodesCountAsTheNextOne) {
  InformationGain graph;
  graph.add(node(kA, 0));
  graph.add(node(kA, 1, {}, 1));
  EXPECT_GT(worth(graph, {kA, 0}, {kA, 1}), 9.0);
  graph.add(node(kB, 0));
  graph.add(node(kB, 4));
  EXPECT_NEAR(worth(graph, {kB, 0}, {kB, 4}), of_variance(4 * scalar(kStep)), 1e-4);
}

TEST(InformationGain, WhatIsUnknownOrAmbiguousOrAbsurdTellsNothing) {
  InformationGain graph;
  graph.add(node(kA, 0));
  graph.add(node(kB, 0));
  EXPECT_EQ(worth(graph, {kA, 0}, {kC, 7}), 0.0);
  EXPECT_EQ(worth(graph, {kA, 0}, {kA, 0}), 0.0);
  Alignment two = alignment({kA, 0}, {kB, 0});
  two.modes.resize(2);
  graph.add(two);
  graph.add(alignment({kA, 0}, {kC, 7}));
  graph.add(alignment({kA, 0}, {kB, 0}, std::nan("")));
  EXPECT_GT(worth(graph, {kA, 0}, {kB, 0}), 9.0);
}

}  // namespace
}  // namespace fleetmap::graph
