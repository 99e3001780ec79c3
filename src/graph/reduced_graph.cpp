#include "reduced_graph.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <set>

namespace fleetmap::graph {
namespace {

constexpr std::size_t kMaxWindowNodes = 16;
constexpr double kOdometryFloorM = 1e-3;       // m a step: a node's pose is rounded on the wire
constexpr double kOdometryFloorRad = 2e-4;     // rad a step
constexpr double kMostSigma = 1e3;             // m; what is worse is no fix
constexpr double kLeastRestVariance = 0.01;    // m^2, of a window's mean fix
constexpr double kLeastTiltVariance = 1.2e-5;  // rad^2, (0.2 deg)^2
constexpr double kMostRotationVariance = 4.0;  // rad^2

Eigen::Vector3d position_variance(const Node& node) {
  return node.G->covariance.diagonal().head<3>().cwiseMax(1e-6).cwiseMin(kMostSigma * kMostSigma);
}

/// What an agent's GPS usually is: the median variance of its nodes, axis by axis. What a node has beyond
/// that, as in an outage, does not drift along with the rest.
std::map<AgentId, Eigen::Vector3d> usual_variances(const std::vector<const Node*>& nodes) {
  std::map<AgentId, std::array<std::vector<double>, 3>> all;
  for (const Node* node : nodes) {
    const Eigen::Vector3d variance = position_variance(*node);
    for (int axis = 0; axis < 3; ++axis)
      all[node->id.agent][static_cast<std::size_t>(axis)].push_back(variance(axis));
  }
  std::map<AgentId, Eigen::Vector3d> usual;
  for (auto& [agent, axes] : all) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      auto middle = axes[axis].begin() + static_cast<std::ptrdiff_t>(axes[axis].size() / 2);
      std::ranges::nth_element(axes[axis], middle);
      usual[agent](static_cast<Eigen::Index>(axis)) = *middle;
    }
  }
  return usual;
}

struct Step {
  double metres = 0.0;
  double seconds = 0.0;
};

Step between(const Node& a, const Node& b) {
  return {(b.T_odom_base.translation() - a.T_odom_base.translation()).norm(),
          std::abs(to_seconds(b.stamp - a.stamp))};
}

/// First node of each window of a frame.
std::vector<std::size_t> window_starts(const ReducedGraph& graph, const FrameSpan& frame,
                                       const FleetPlacementConfig& config) {
  std::vector<std::size_t> starts{frame.first};
  Step since;
  for (std::size_t k = frame.first + 1; k < frame.end; ++k) {
    const Step step = between(*graph.nodes[k - 1], *graph.nodes[k]);
    since.metres += step.metres;
    since.seconds += step.seconds;
    if (since.metres < config.window_m && since.seconds < 0.5 * config.gps_correlation_time &&
        k - starts.back() < kMaxWindowNodes) {
      continue;
    }
    starts.push_back(k);
    since = {};
  }
  return starts;
}

/// The fixes of nodes [first, end) as one of the pillar at `first`.
void fill_window(Pillar& pillar, const ReducedGraph& graph, std::size_t end, const LocalFrame& site,
                 const Eigen::Vector3d& usual, const FleetPlacementConfig& config) {
  const Node& anchor = *graph.nodes[pillar.node];
  const Pose T_base_odom = anchor.T_odom_base.inverse();
  const double count = static_cast<double>(end - pillar.node);
  Eigen::Vector3d drift = Eigen::Vector3d::Zero(), rest = Eigen::Vector3d::Zero();
  for (std::size_t k = pillar.node; k < end; ++k) {
    const Node& node = *graph.nodes[k];
    pillar.lever += T_base_odom * Eigen::Vector3d(node.T_odom_base.translation());
    pillar.fix += site.to_enu(node.G->position);
    const Eigen::Vector3d variance = position_variance(node);
    const Eigen::Vector3d drifting = config.gps_drift_share * variance.cwiseMin(usual);
    drift += drifting;
    rest += variance - drifting;
  }
  pillar.has_window = true;
  pillar.lever /= count;
  pillar.fix /= count;
  pillar.drift_sigma = (drift / count).cwiseSqrt();
  pillar.rest_variance = (rest / count).array() + kLeastRestVariance;
  const double seconds = std::abs(to_seconds(graph.nodes[end - 1]->stamp - anchor.stamp));
  // The orientation's error drifts as well: fixes closer in time than its correlation share one.
  const double shared = std::max(1.0, config.gps_correlation_time / std::max(1.0, seconds));
  const Pose T = pose_in(site, *anchor.G);
  pillar.R_enu_base = T.linear();
  pillar.rotation_variance = shared * anchor.G->covariance.diagonal().tail<3>().cwiseMax(kLeastTiltVariance);
  pillar.rotation_variance = pillar.rotation_variance.cwiseMin(kMostRotationVariance);
}

void add_frame(ReducedGraph& graph, FrameSpan frame, const std::vector<bool>& is_end, const LocalFrame& site,
               const std::map<AgentId, Eigen::Vector3d>& usual, const FleetPlacementConfig& config) {
  const std::vector<std::size_t> starts = window_starts(graph, frame, config);
  std::size_t window = 0;
  frame.first_pillar = graph.pillars.size();
  Matrix6d covariance = Matrix6d::Zero();
  for (std::size_t k = frame.first; k < frame.end; ++k) {
    const Node& node = *graph.nodes[k];
    if (k > frame.first) {
      const Matrix6d carry = adjoint(node.T_odom_base.inverse() * graph.nodes[k - 1]->T_odom_base);
      covariance = carry * covariance * carry.transpose() + odometry_step(graph, k);
    }
    const bool starts_window = window < starts.size() && starts[window] == k;
    if (!starts_window && !is_end[k] && k + 1 != frame.end) continue;
    Pillar pillar;
    pillar.node = k;
    pillar.frame = graph.frames.size();
    if (starts_window) {
      const std::size_t end = window + 1 < starts.size() ? starts[window + 1] : frame.end;
      fill_window(pillar, graph, end, site, usual.at(node.id.agent), config);
      pillar.seconds = to_seconds(node.stamp - graph.nodes.front()->stamp);
      ++window;
    }
    if (k > frame.first) {
      const std::size_t a = graph.pillars.size() - 1;
      const Node& before = *graph.nodes[graph.pillars[a].node];
      graph.odometry.emplace_back(a, a + 1, before.T_odom_base.inverse() * node.T_odom_base, covariance);
    }
    covariance.setZero();
    if (is_end[k]) graph.pillar_of[node.id] = graph.pillars.size();
    graph.pillars.push_back(pillar);
  }
  frame.end_pillar = graph.pillars.size();
  graph.frames.push_back(frame);
}

/// The drift of a robot's GPS goes on when its program starts anew.
void link_drifts(ReducedGraph& graph, const FleetPlacementConfig& config) {
  std::map<AgentId, std::vector<std::size_t>> windows;
  for (std::size_t p = 0; p < graph.pillars.size(); ++p) {
    if (graph.pillars[p].has_window) windows[graph.nodes[graph.pillars[p].node]->id.agent].push_back(p);
  }
  for (auto& [agent, of_agent] : windows) {
    std::ranges::stable_sort(of_agent, {}, [&](std::size_t p) { return graph.pillars[p].seconds; });
    for (std::size_t k = 1; k < of_agent.size(); ++k) {
      const double seconds = graph.pillars[of_agent[k]].seconds - graph.pillars[of_agent[k - 1]].seconds;
      const double decay = std::exp(-std::max(seconds, 0.1) / config.gps_correlation_time);
      graph.drift.push_back({of_agent[k - 1], of_agent[k], decay});
    }
  }
}

}  // namespace

Between::Between(std::size_t from, std::size_t to, const Pose& T_from_to, const Matrix6d& C)
    : a(from), b(to), T_a_b(T_from_to), covariance(C), information(C.llt().solve(Matrix6d::Identity())) {}

Matrix6d odometry_step(const ReducedGraph& graph, std::size_t k) {
  const Node& node = *graph.nodes[k];
  // Of nodes that have not come yet, the covariance is taken to be like this one's.
  const double steps = static_cast<double>(node.id.seq - graph.nodes[k - 1]->id.seq);
  Matrix6d C = node.odom_covariance;
  C.diagonal().head<3>().array() += kOdometryFloorM * kOdometryFloorM;
  C.diagonal().tail<3>().array() += kOdometryFloorRad * kOdometryFloorRad;
  return std::max(1.0, steps) * C;
}

ReducedGraph reduce(std::span<const Node* const> nodes, std::span<const NodeId> ends, const LocalFrame& site,
                    const FleetPlacementConfig& config) {
  ReducedGraph graph;
  graph.nodes.assign(nodes.begin(), nodes.end());
  std::ranges::sort(graph.nodes, [](const Node* a, const Node* b) {
    return std::pair(a->frame(), a->id.seq) < std::pair(b->frame(), b->id.seq);
  });
  const std::set<NodeId> wanted(ends.begin(), ends.end());
  std::vector<bool> is_end(graph.nodes.size());
  for (std::size_t k = 0; k < graph.nodes.size(); ++k) is_end[k] = wanted.contains(graph.nodes[k]->id);
  const auto usual = usual_variances(graph.nodes);
  for (std::size_t first = 0; first < graph.nodes.size();) {
    std::size_t end = first + 1;
    while (end < graph.nodes.size() && graph.nodes[end]->frame() == graph.nodes[first]->frame()) ++end;
    add_frame(graph, {graph.nodes[first]->frame(), first, end, 0, 0}, is_end, site, usual, config);
    first = end;
  }
  link_drifts(graph, config);
  return graph;
}

}  // namespace fleetmap::graph
