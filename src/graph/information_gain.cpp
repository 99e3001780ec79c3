#include "fleetmap/graph/information_gain.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <set>

namespace fleetmap::graph {
namespace {

/// m^2: assumed variance of a future alignment, about 2 cm and 0.07 deg.
constexpr double kExpectedVariance = 1.5e-3;
/// m^2: lower bound of the variance of an edge.
constexpr double kMinVariance = 1e-6;
/// m^2: variance of a track without GPS and alignments.
constexpr double kUnconstrained = 1e6;

double scalar(const Matrix6d& covariance) {
  const double squared = covariance.diagonal().head<3>().sum() + InformationGain::kLever *
                                                                     InformationGain::kLever *
                                                                     covariance.diagonal().tail<3>().sum();
  return std::isfinite(squared) ? std::clamp(squared, kMinVariance, kUnconstrained) : kUnconstrained;
}

}  // namespace

/// Nodes that are ends of edges, and the conductances (1 / variance) between them and to the ground.
class InformationGain::Network {
 public:
  explicit Network(const std::set<NodeId>& nodes) {
    for (const NodeId& node : nodes) index_.emplace(node, static_cast<Eigen::Index>(index_.size()));
    for (Eigen::Index k = 0; k < size(); ++k) entries_.emplace_back(k, k, 1.0 / kUnconstrained);
  }

  void connect(const NodeId& a, const NodeId& b, double variance) {
    const Eigen::Index i = index_.at(a), j = index_.at(b);
    if (i == j) return;
    const double conductance = 1.0 / std::max(variance, kMinVariance);
    entries_.emplace_back(i, i, conductance);
    entries_.emplace_back(j, j, conductance);
    entries_.emplace_back(i, j, -conductance);
    entries_.emplace_back(j, i, -conductance);
  }
  void ground(const NodeId& node, double variance) {
    const Eigen::Index k = index_.at(node);
    entries_.emplace_back(k, k, 1.0 / std::max(variance, kMinVariance));
  }
  bool solve() {
    Eigen::SparseMatrix<double> laplacian(size(), size());
    laplacian.setFromTriplets(entries_.begin(), entries_.end());
    factor_.compute(laplacian);
    return factor_.info() == Eigen::Success;
  }
  /// m^2
  double between(const NodeId& a, const NodeId& b) const {
    Eigen::VectorXd current = Eigen::VectorXd::Zero(size());
    current[index_.at(a)] += 1.0;
    current[index_.at(b)] -= 1.0;
    return std::max(current.dot(factor_.solve(current)), 0.0);
  }

 private:
  Eigen::Index size() const { return static_cast<Eigen::Index>(index_.size()); }

  std::map<NodeId, Eigen::Index> index_;
  std::vector<Eigen::Triplet<double>> entries_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
};

void InformationGain::add(const Node& node) {
  if (!track_nodes_.emplace(node.id, TrackNode{node.frame(), scalar(node.odom_covariance)}).second || !node.G)
    return;
  const double variance = scalar(node.G->covariance);
  const auto [fix, first] = fixes_.try_emplace(node.frame(), Fix{node.id, variance});
  if (!first && variance < fix->second.variance) fix->second = {node.id, variance};
}

void InformationGain::use(std::span<const Alignment> used) {
  alignments_.clear();
  for (const Alignment& alignment : used) add(alignment);
}

void InformationGain::add(const Alignment& alignment) {
  if (alignment.ambiguous()) return;
  alignments_.push_back({{alignment.i, alignment.j}, scalar(alignment.best().covariance)});
}

double InformationGain::along_track(const NodeId& from, const NodeId& to) const {
  double variance = 0.0;
  std::uint32_t before = from.seq;
  for (auto place = track_nodes_.upper_bound(from); place != track_nodes_.end() && !(to < place->first);
       ++place) {
    variance += place->second.variance * static_cast<double>(place->first.seq - before);
    before = place->first.seq;
  }
  return variance;
}

std::vector<double> InformationGain::of(std::span<const Pair> pairs, std::span<const Pair> expected) const {
  const auto known = [&](const Pair& pair) {
    return track_nodes_.contains(pair.first) && track_nodes_.contains(pair.second);
  };
  std::vector<Edge> edges;
  std::ranges::copy_if(alignments_, std::back_inserter(edges),
                       [&](const Edge& edge) { return known(edge.pair); });
  for (const Pair& pair : expected) {
    if (known(pair)) edges.push_back({pair, kExpectedVariance});
  }
  std::set<NodeId> ends;
  for (const Edge& edge : edges) ends.insert({edge.pair.first, edge.pair.second});
  for (const Pair& pair : pairs) {
    if (known(pair)) ends.insert({pair.first, pair.second});
  }
  for (const auto& [frame, fix] : fixes_) ends.insert(fix.node);

  Network network(ends);
  for (const Edge& edge : edges) network.connect(edge.pair.first, edge.pair.second, edge.variance);
  for (const auto& [frame, fix] : fixes_) network.ground(fix.node, fix.variance);
  for (auto end = ends.begin(); end != ends.end() && std::next(end) != ends.end(); ++end) {
    const auto next = std::next(end);
    if (track_nodes_.at(*end).frame == track_nodes_.at(*next).frame)
      network.connect(*end, *next, along_track(*end, *next));
  }
  std::vector<double> worths(pairs.size(), 0.0);
  if (!network.solve()) return worths;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (known(pairs[k]))
      worths[k] = 0.5 * std::log1p(network.between(pairs[k].first, pairs[k].second) / kExpectedVariance);
  }
  return worths;
}

}  // namespace fleetmap::graph
