#include "standard_rejection.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "fleetmap/geometry/symmetric.hpp"
#include "fleetmap/geometry/uncertain_pose.hpp"

namespace fleetmap::graph::bench {
namespace {

// ---- pairwise consistency

/// Odometry between any two pose variables of a frame. Its covariance follows from sums of the factors'
/// covariances that are carried to the frame's origin.
class Odometry {
 public:
  explicit Odometry(const ReducedGraph& graph) : graph_(graph), sum_(graph.poses.size(), Matrix6d::Zero()) {
    for (const BetweenFactor& step : graph.odometry) {
      const Matrix6d carry = adjoint(pose(step.b));
      sum_[step.b] = sum_[step.a] + carry * step.covariance * carry.transpose();
    }
  }
  UncertainPose between(std::size_t a, std::size_t b) const {
    if (a > b) return inverse(between(b, a));
    const Matrix6d carry = adjoint(pose(b).inverse());
    return {pose(a).inverse() * pose(b), carry * (sum_[b] - sum_[a]) * carry.transpose()};
  }

 private:
  const Pose& pose(std::size_t p) const { return graph_.nodes[graph_.poses[p].node]->T_odom_base; }
  const ReducedGraph& graph_;
  std::vector<Matrix6d> sum_;
};

/// A candidate from the first frame of its pair to the second.
struct Measurement {
  std::size_t a = 0, b = 0;
  UncertainPose T_a_b;
};

Measurement oriented(const Candidate& candidate) {
  const BetweenFactor& factor = candidate.factor;
  const UncertainPose T{factor.T_a_b, factor.covariance};
  if (candidate.sign > 0.0) return {factor.a, factor.b, T};
  return {factor.b, factor.a, inverse(T)};
}

bool are_consistent(const Measurement& k, const Measurement& l, const Odometry& odometry) {
  const UncertainPose along = compose(odometry.between(k.a, l.a), l.T_a_b);
  const UncertainPose loop = compose(compose(inverse(k.T_a_b), along), odometry.between(l.b, k.b));
  const Vector6d e = se3_log(loop.T_a_b);
  return CholeskyOf(loop.covariance).squared_distance(e) < kGate;
}

using Adjacency = std::vector<std::vector<bool>>;

Indices largest_clique(const Adjacency& adjacent) {
  const std::size_t n = adjacent.size();
  std::vector<std::ptrdiff_t> degree;
  for (const auto& row : adjacent) degree.push_back(std::ranges::count(row, true));
  Indices best;
  for (std::size_t v = 0; v < n; ++v) {
    Indices clique{v}, open;
    for (std::size_t u = 0; u < n; ++u)
      if (adjacent[v][u]) open.push_back(u);
    while (!open.empty()) {
      const std::size_t next = *std::ranges::max_element(open, {}, [&](std::size_t u) { return degree[u]; });
      clique.push_back(next);
      std::erase_if(open, [&](std::size_t u) { return !adjacent[next][u]; });
    }
    if (clique.size() > best.size()) best = clique;
  }
  return best;
}

// ---- reweighting

/// Gauss-Newton on the graph with weighted candidates. GraphSolver's Huber kernel does not act on them while
/// w r^2 is below its threshold, which both kernels here see to but for the first steps.
class WeightedLeastSquares {
 public:
  WeightedLeastSquares(const ReducedGraph& graph, std::span<const Candidate> candidates,
                       const Estimate& initial)
      : candidates_(candidates), estimate_(initial), solver_(graph, ends(candidates)) {
    GraphSolver(graph, {}).solve(estimate_, kMaxSteps);
    for (const Candidate& candidate : candidates) factors_.push_back(candidate.factor);
  }
  void solve(std::span<const double> weights, int steps) {
    std::vector<const BetweenFactor*> factors;
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      if (weights[c] < 1e-9) continue;
      factors_[c].information = weights[c] * candidates_[c].factor.information;
      factors.push_back(&factors_[c]);
    }
    solver_.set_alignments(factors);
    solver_.solve(estimate_, steps);
  }
  /// r^2 of each candidate.
  std::vector<double> squared_residuals() const {
    std::vector<double> squared;
    for (const Candidate& candidate : candidates_) {
      const BetweenFactor& factor = candidate.factor;
      const Vector6d e = relative_residual(estimate_, factor.a, factor.b, factor.T_a_b).e;
      squared.push_back(e.dot(factor.information * e));
    }
    return squared;
  }
  const Estimate& estimate() const { return estimate_; }

 private:
  static std::vector<GraphSolver::Ends> ends(std::span<const Candidate> candidates) {
    std::vector<GraphSolver::Ends> pairs;
    for (const Candidate& candidate : candidates) pairs.emplace_back(candidate.factor.a, candidate.factor.b);
    return pairs;
  }
  std::span<const Candidate> candidates_;
  Estimate estimate_;
  GraphSolver solver_;
  std::vector<BetweenFactor> factors_;
};

constexpr int kStepsPerWeights = 5;
constexpr int kMaxReweightings = 200;
constexpr double kGncFactor = 1.4;

double truncated_weight(double squared, double mu) {
  if (squared >= (mu + 1.0) / mu * kGate) return 0.0;
  if (squared <= mu / (mu + 1.0) * kGate) return 1.0;
  return std::sqrt(kGate * mu * (mu + 1.0) / squared) - mu;
}

}  // namespace

Outcome least_squares(const ReducedGraph& graph, std::span<const Candidate> candidates,
                      const Estimate& initial, const std::vector<bool>& kept) {
  WeightedLeastSquares problem(graph, candidates, initial);
  problem.solve(std::vector<double>(kept.begin(), kept.end()), kMaxSteps);
  return {kept, problem.estimate()};
}

Outcome pcm(const ReducedGraph& graph, std::span<const Candidate> candidates, const Estimate& initial) {
  std::map<FramePair, Indices> groups;
  for (std::size_t c = 0; c < candidates.size(); ++c) groups[candidates[c].frames].push_back(c);
  const Odometry odometry(graph);
  std::vector<bool> kept(candidates.size(), false);
  for (const auto& [frames, group] : groups) {
    std::vector<Measurement> measurements;
    for (const std::size_t c : group) measurements.push_back(oriented(candidates[c]));
    Adjacency adjacent(group.size(), std::vector<bool>(group.size(), false));
    for (std::size_t k = 0; k < group.size(); ++k) {
      for (std::size_t l = 0; l < k; ++l)
        adjacent[k][l] = adjacent[l][k] = candidates[group[k]].alignment != candidates[group[l]].alignment &&
                                          are_consistent(measurements[k], measurements[l], odometry);
    }
    for (const std::size_t k : largest_clique(adjacent)) kept[group[k]] = true;
  }
  return least_squares(graph, candidates, initial, kept);
}

Outcome gnc(const ReducedGraph& graph, std::span<const Candidate> candidates, const Estimate& initial,
            const std::vector<bool>& among) {
  WeightedLeastSquares problem(graph, candidates, initial);
  std::vector<double> weights(among.begin(), among.end());
  problem.solve(weights, kMaxSteps);
  std::vector<double> squared = problem.squared_residuals();
  double largest = 0.0;
  for (std::size_t c = 0; c < squared.size(); ++c)
    if (among[c]) largest = std::max(largest, squared[c]);
  double mu = kGate / std::max(2.0 * largest - kGate, 1e-3);
  for (int iteration = 0; iteration < kMaxReweightings; ++iteration, mu *= kGncFactor) {
    bool binary = true;
    for (std::size_t c = 0; c < weights.size(); ++c) {
      if (among[c]) weights[c] = truncated_weight(squared[c], mu);
      binary = binary && (weights[c] == 0.0 || weights[c] == 1.0);
    }
    problem.solve(weights, binary ? kMaxSteps : kStepsPerWeights);
    squared = problem.squared_residuals();
    if (binary && mu > 1.0) break;
  }
  std::vector<bool> kept;
  for (const double weight : weights) kept.push_back(weight > 0.5);
  return {kept, problem.estimate()};
}

Outcome cauchy(const ReducedGraph& graph, std::span<const Candidate> candidates, const Estimate& initial) {
  WeightedLeastSquares problem(graph, candidates, initial);
  std::vector<double> squared = problem.squared_residuals();
  for (int iteration = 0; iteration < kMaxReweightings; ++iteration) {
    std::vector<double> weights;
    for (const double r2 : squared) weights.push_back(1.0 / (1.0 + r2 / kGate));
    problem.solve(weights, kStepsPerWeights);
    const std::vector<double> next = problem.squared_residuals();
    double change = 0.0;
    for (std::size_t c = 0; c < next.size(); ++c)
      change = std::max(change, std::abs(std::sqrt(next[c]) - std::sqrt(squared[c])));
    squared = next;
    if (change < 0.01) break;
  }
  std::vector<bool> kept;
  for (const double r2 : squared) kept.push_back(r2 < kGate);
  return {kept, problem.estimate()};
}

}  // namespace fleetmap::graph::bench
