#include "fleetmap/graph/information_gain.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>

namespace fleetmap::graph {
namespace {

/// m^2: assumed variance of a future alignment, about 2 cm and 0.07 deg.
constexpr double kExpectedVariance = 1.5e-3;
/// m^2: lower bound of the variance of an edge.
constexpr double kMinVariance = 1e-6;
/// m^2: variance of a track without GPS and alignments.
constexpr double kUnconstrained = 1e6;
/// Nodes of the first and of the largest neighbourhood, beside those of the pairs, and how it grows.
constexpr std::size_t kFirstNodes = 64, kMaxNodes = 4096, kGrowth = 4;

double scalar(const Matrix6d& covariance) {
  const double squared = covariance.diagonal().head<3>().sum() + InformationGain::kLever *
                                                                     InformationGain::kLever *
                                                                     covariance.diagonal().tail<3>().sum();
  return std::isfinite(squared) ? std::clamp(squared, kMinVariance, kUnconstrained) : kUnconstrained;
}

}  // namespace

/// The ends of edges nearest to some pairs, and the conductances (1 / variance) between them and to the
/// ground.
class InformationGain::Neighbourhood {
 public:
  /// Treats the edges that leave the neighbourhood as absent, or as fixed to the ground.
  enum class Border : std::uint8_t { kCut, kGrounded };

  /// The graph and the expected edges outlive this.
  Neighbourhood(const InformationGain& graph, const Edges& expected, std::span<const Pair> pairs)
      : graph_(graph), expected_(expected) {
    for (const Pair& pair : pairs) {
      for (const NodeId& node : {pair.first, pair.second}) {
        seeds_.emplace(node, Edge{node, kMinVariance});
        reach(node, 0.0);
      }
    }
  }

  /// Adds the nearest ends until there are `count`.
  void grow(std::size_t count) {
    while (ends_.size() < count && !frontier_.empty()) {
      const auto [distance, node] = *frontier_.begin();
      frontier_.erase(frontier_.begin());
      index_.emplace(node, static_cast<Eigen::Index>(ends_.size()));
      ends_.push_back({node, edges_of(node)});
      for (const Edge& edge : ends_.back().edges) reach(edge.to, distance + edge.variance);
    }
  }
  /// No edge leaves it.
  bool whole() const { return frontier_.empty(); }

  bool factorise(Border border) {
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t k = 0; k < ends_.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      double diagonal = ground(ends_[k].node);
      for (const Edge& edge : ends_[k].edges) {
        const auto other = index_.find(edge.to);
        const double conductance = 1.0 / std::max(edge.variance, kMinVariance);
        if (other != index_.end()) entries.emplace_back(i, other->second, -conductance);
        if (other != index_.end() || border == Border::kGrounded) diagonal += conductance;
      }
      entries.emplace_back(i, i, diagonal);
    }
    Eigen::SparseMatrix<double> laplacian(size(), size());
    laplacian.setFromTriplets(entries.begin(), entries.end());
    factor_.compute(laplacian);
    return factor_.info() == Eigen::Success;
  }
  /// Nats, by the last factorisation.
  double gain(const Pair& pair) const {
    Eigen::VectorXd current = Eigen::VectorXd::Zero(size());
    current[index_.at(pair.first)] += 1.0;
    current[index_.at(pair.second)] -= 1.0;
    const double resistance = current.dot(factor_.solve(current));
    return 0.5 * std::log1p(std::max(resistance, 0.0) / kExpectedVariance);
  }

 private:
  struct End {
    NodeId node;
    std::vector<Edge> edges;
  };

  Eigen::Index size() const { return static_cast<Eigen::Index>(ends_.size()); }

  void reach(const NodeId& node, double distance) {
    if (index_.contains(node)) return;
    const auto [known, first] = distance_.try_emplace(node, distance);
    if (!first) {
      if (known->second <= distance) return;
      frontier_.erase({known->second, node});
      known->second = distance;
    }
    frontier_.emplace(distance, node);
  }

  double ground(const NodeId& node) const {
    const auto fix = graph_.fixes_.find(graph_.track_nodes_.at(node).frame);
    const bool is_fix = fix != graph_.fixes_.end() && fix->second.node == node;
    return 1.0 / kUnconstrained + (is_fix ? 1.0 / std::max(fix->second.variance, kMinVariance) : 0.0);
  }

  std::vector<Edge> edges_of(const NodeId& node) const {
    std::vector<Edge> edges;
    for (const Edges* all : {&graph_.alignments_, &expected_}) {
      const auto [first, last] = all->equal_range(node);
      for (auto edge = first; edge != last; ++edge) {
        if (edge->second.to != node && graph_.track_nodes_.contains(edge->second.to))
          edges.push_back(edge->second);
      }
    }
    const double along = graph_.track_nodes_.at(node).along;
    if (const auto next = beside(node, true)) edges.push_back({next->first, next->second - along});
    if (const auto before = beside(node, false)) edges.push_back({before->first, along - before->second});
    return edges;
  }

  /// The end that follows or precedes `node` in its frame, and its way along the track.
  std::optional<std::pair<NodeId, double>> beside(const NodeId& node, bool later) const {
    const FrameId& frame = graph_.track_nodes_.at(node).frame;
    std::optional<std::pair<NodeId, double>> nearest;
    const auto consider = [&](const NodeId& end) {
      const auto place = graph_.track_nodes_.find(end);
      if (place == graph_.track_nodes_.end()) return false;
      const bool nearer = !nearest || (later ? end < nearest->first : nearest->first < end);
      if (nearer && place->second.frame == frame) nearest = {end, place->second.along};
      return true;
    };
    // Ends that are no known nodes are skipped.
    for (const Edges* ends : {&graph_.alignments_, &expected_, &seeds_}) {
      auto end = later ? ends->upper_bound(node) : ends->lower_bound(node);
      if (later) {
        while (end != ends->end() && !consider(end->first)) ++end;
      } else {
        while (end != ends->begin() && !consider((--end)->first)) continue;
      }
    }
    if (const auto fix = graph_.fixes_.find(frame);
        fix != graph_.fixes_.end() && (later ? node < fix->second.node : fix->second.node < node))
      consider(fix->second.node);
    return nearest;
  }

  const InformationGain& graph_;
  const Edges& expected_;
  Edges seeds_;  ///< from each node of the pairs to itself
  std::vector<End> ends_;
  std::map<NodeId, Eigen::Index> index_;  ///< in ends_
  std::map<NodeId, double> distance_;     ///< m^2, from the nearest seed along edges, of the nodes reached
  std::set<std::pair<double, NodeId>> frontier_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
};

void InformationGain::add(const Node& node) {
  const auto [place, is_new] =
      track_nodes_.emplace(node.id, TrackNode{node.frame(), scalar(node.odom_covariance), 0.0});
  if (!is_new) return;
  // Later nodes of the frame are there only if this one comes late.
  for (auto later = place; later != track_nodes_.end() && later->second.frame == node.frame(); ++later) {
    if (later == track_nodes_.begin()) continue;
    const auto before = std::prev(later);
    if (before->second.frame != node.frame()) continue;
    later->second.along = before->second.along +
                          later->second.variance * static_cast<double>(later->first.seq - before->first.seq);
  }
  if (!node.G) return;
  const double variance = scalar(node.G->covariance);
  const auto [fix, first] = fixes_.try_emplace(node.frame(), Fix{node.id, variance});
  if (!first && variance < fix->second.variance) fix->second = {node.id, variance};
}

void InformationGain::use(std::span<const Alignment> used) {
  alignments_.clear();
  for (const Alignment& alignment : used) add(alignment);
}

void InformationGain::add(const Alignment& alignment) {
  if (!alignment.ambiguous())
    connect(alignments_, {alignment.i, alignment.j}, scalar(alignment.best().covariance));
}

void InformationGain::connect(Edges& edges, const Pair& pair, double variance) {
  edges.emplace(pair.first, Edge{pair.second, variance});
  edges.emplace(pair.second, Edge{pair.first, variance});
}

bool InformationGain::known(const Pair& pair) const {
  return track_nodes_.contains(pair.first) && track_nodes_.contains(pair.second);
}

std::vector<double> InformationGain::of(std::span<const Pair> pairs, std::span<const Pair> expected) const {
  Edges expected_edges;
  for (const Pair& pair : expected) {
    if (known(pair)) connect(expected_edges, pair, kExpectedVariance);
  }
  std::vector<double> gains(pairs.size(), 0.0);
  std::vector<std::size_t> open;  // the bounds of their gains differ
  std::vector<Pair> known_pairs;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (!known(pairs[k])) continue;
    open.push_back(k);
    known_pairs.push_back(pairs[k]);
  }
  Neighbourhood part(*this, expected_edges, known_pairs);
  for (std::size_t nodes = kFirstNodes; !open.empty(); nodes *= kGrowth) {
    part.grow(2 * known_pairs.size() + nodes);
    if (!part.factorise(Neighbourhood::Border::kCut)) break;
    for (const std::size_t k : open) gains[k] = part.gain(pairs[k]);
    if (part.whole() || nodes >= kMaxNodes || !part.factorise(Neighbourhood::Border::kGrounded)) break;
    std::erase_if(open, [&](std::size_t k) {
      const double lower_bound = part.gain(pairs[k]);
      if (gains[k] - lower_bound > kTolerance) return false;
      gains[k] = 0.5 * (gains[k] + lower_bound);
      return true;
    });
  }
  return gains;
}

}  // namespace fleetmap::graph
