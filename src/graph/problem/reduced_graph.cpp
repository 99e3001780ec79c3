#include "problem/reduced_graph.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "fleetmap/geometry/symmetric.hpp"

namespace fleetmap::graph {
namespace {

constexpr std::size_t kMaxWindowNodes = 16;
constexpr double kOdometryFloorM = 1e-3;      // m a step: a node's pose is rounded on the wire
constexpr double kOdometryFloorRad = 2e-4;    // rad a step
constexpr double kMaxSigma = 1e3;             // m; what is worse is no fix
constexpr double kMinRestVariance = 0.01;     // m^2, of a window's mean fix
constexpr double kMinTiltVariance = 2.5e-7;   // rad^2, (0.03 deg)^2
constexpr double kMaxRotationVariance = 4.0;  // rad^2
/// Variance that a filter adds each second that it reckons by wheels and gyro.
constexpr double kReckoning = 0.01;        // m^2/s
constexpr double kReckoningTurn = 4e-6;    // rad^2/s
constexpr double kMaxCorrelation = 0.998;  // keeps the equations well conditioned

struct Step {
  double metres = 0.0;
  double seconds = 0.0;
};

Step between(const Node& a, const Node& b) {
  return {(b.T_odom_base.translation() - a.T_odom_base.translation()).norm(),
          std::abs(to_seconds(b.stamp - a.stamp))};
}

/// Nodes [first, end) of a frame, whose fixes count as one.
struct Window {
  std::size_t first = 0, end = 0;
  Vector6d variance = Vector6d::Zero();  ///< of G, the mean
  Vector6d before = Vector6d::Zero();    ///< of the window before, zero if there is none
  double seconds = 0.0;                  ///< since that one
  /// Of the position, what no reckoning since has made worse: what is above it comes and goes with the way
  /// (a false heading leads off it, and back again), and holds nothing that fixes say.
  Eigen::Vector3d best = Eigen::Vector3d::Zero();
};

Vector6d variance_of(const Node& node) {
  Vector6d variance = node.G->covariance.diagonal();
  variance.head<3>() = variance.head<3>().cwiseMax(1e-6).cwiseMin(kMaxSigma * kMaxSigma);
  variance.tail<3>() = variance.tail<3>().cwiseMax(kMinTiltVariance).cwiseMin(kMaxRotationVariance);
  return variance;
}

/// G says nothing new: without fixes the variances of height and heading can but grow. Those of east and
/// north may shrink, as when the robot comes back to where its heading was known, but not below `known`.
bool reckoned(const Window& window, const Vector6d& known) {
  return window.variance(2) > window.before(2) && window.variance(5) > window.before(5) &&
         window.variance.head<2>().sum() > known.head<2>().sum();
}

/// Windows of a frame that hold fixes; the first of it in any case.
std::vector<Window> windows_of(const ReducedGraph& graph, const FrameSpan& frame,
                               const FleetPlacementConfig& config) {
  std::vector<Window> windows{{.first = frame.first}};
  Step since;
  for (std::size_t k = frame.first + 1; k < frame.end; ++k) {
    const Step step = between(*graph.nodes[k - 1], *graph.nodes[k]);
    since.metres += step.metres;
    since.seconds += step.seconds;
    if (since.metres < config.window_m && since.seconds < 0.5 * config.gps_correlation_time &&
        k - windows.back().first < kMaxWindowNodes) {
      continue;
    }
    windows.back().end = k;
    windows.push_back({.first = k, .seconds = since.seconds});
    since = {};
  }
  windows.back().end = frame.end;
  std::vector<Window> fixed;
  for (Window& window : windows) {
    for (std::size_t k = window.first; k < window.end; ++k)
      window.variance += variance_of(*graph.nodes[k]) / static_cast<double>(window.end - window.first);
    window.best = window.variance.head<3>();
    if (&window != &windows.front()) {
      const Window& before = *(&window - 1);
      window.before = before.variance;
      window.best = window.best.cwiseMin((before.best.array() + kReckoning * window.seconds).matrix());
    }
    if (fixed.empty() || !reckoned(window, fixed.back().variance)) fixed.push_back(window);
  }
  return fixed;
}

/// What share of a filter's error is left at the end of some time, in an axis: what it is sure of, V_a, grows
/// by the variance of its reckoning, until fixes make it V_b. All is left where they did not. The drift of
/// the fixes themselves is left as well, though the filter may not know.
double share_left(double V_a, double V_b, double reckoning, double seconds,
                  const FleetPlacementConfig& config) {
  const double drift = std::exp(-seconds / config.gps_correlation_time);
  const double left = std::max(drift, V_b / (V_a + reckoning * seconds));
  return std::min(left, std::min(1.0, V_b / V_a));
}

/// Of the heading of G, as if it were independent of the window before: there is no variable for its error.
double heading_variance(const Window& window, const FleetPlacementConfig& config) {
  const double V_a = window.before(5), V_b = window.variance(5);
  if (V_a == 0.0) return V_b;
  const double left = share_left(V_a, V_b, kReckoningTurn, window.seconds, config);
  const double information = (1.0 - left) * (1.0 - left) / std::max(V_b - left * left * V_a, 1e-3 * V_b);
  return 1.0 / std::max(information, 1.0 / kMaxRotationVariance);
}

/// Of the place in a window, by a heading of G that is false for longer than it: each window's track is
/// turned by the same error, which so counts as often as windows share it; of the frame's `windows` at most.
Eigen::Vector3d variance_by_heading(const Window& window, const Eigen::Vector3d& moved_enu, double seconds,
                                    std::size_t windows) {
  const double lasts = window.variance(5) / kReckoningTurn;  // s
  const double shared = std::clamp(lasts / std::max(1.0, seconds), 1.0, static_cast<double>(windows));
  const Eigen::Vector3d across(moved_enu.y(), moved_enu.x(), 0.0);
  return shared * window.variance(5) * across.cwiseAbs2();
}

/// The fixes of a window as one of the variable at its first node.
void fill_window(PoseVariable& variable, const ReducedGraph& graph, const Window& window, std::size_t windows,
                 const LocalFrame& site, const FleetPlacementConfig& config) {
  const Node& anchor = *graph.nodes[variable.node];
  const Pose T_base_odom = anchor.T_odom_base.inverse();
  const double count = static_cast<double>(window.end - window.first);
  for (std::size_t k = window.first; k < window.end; ++k) {
    const Node& node = *graph.nodes[k];
    variable.lever += T_base_odom * Eigen::Vector3d(node.T_odom_base.translation());
    variable.fix += site.to_enu(node.G->position);
  }
  variable.has_window = true;
  variable.lever /= count;
  variable.fix /= count;
  variable.seconds = to_seconds(anchor.stamp - graph.nodes.front()->stamp);
  const Node& last = *graph.nodes[window.end - 1];
  const double seconds = std::abs(to_seconds(last.stamp - anchor.stamp));
  variable.R_enu_base = pose_in(site, *anchor.G).linear();
  const Eigen::Vector3d moved =
      variable.R_enu_base * (T_base_odom * Eigen::Vector3d(last.T_odom_base.translation()));
  const Eigen::Vector3d drift = config.gps_drift_share * window.best;
  variable.drift_sigma = drift.cwiseSqrt();
  variable.rest_variance =
      window.variance.head<3>() - drift + variance_by_heading(window, moved, seconds, windows);
  variable.rest_variance.array() += kMinRestVariance;
  // The level's error drifts as well: what is closer in time than its correlation shares one.
  const double shared = std::max(1.0, config.gps_correlation_time / std::max(1.0, seconds));
  const Vector6d of_anchor = variance_of(anchor);
  variable.rotation_variance << shared * of_anchor.segment<2>(3), heading_variance(window, config);
  variable.rotation_variance = variable.rotation_variance.cwiseMin(kMaxRotationVariance);
}

void add_frame(ReducedGraph& graph, FrameSpan frame, const std::vector<bool>& is_end, const LocalFrame& site,
               const FleetPlacementConfig& config) {
  const std::vector<Window> windows = windows_of(graph, frame, config);
  std::size_t window = 0;
  frame.first_pose = graph.poses.size();
  Matrix6d covariance = Matrix6d::Zero();
  for (std::size_t k = frame.first; k < frame.end; ++k) {
    const Node& node = *graph.nodes[k];
    if (k > frame.first) {
      const Matrix6d carry = adjoint(node.T_odom_base.inverse() * graph.nodes[k - 1]->T_odom_base);
      covariance = carry * covariance * carry.transpose() + odometry_step(graph, k);
    }
    const bool starts_window = window < windows.size() && windows[window].first == k;
    if (!starts_window && !is_end[k] && k + 1 != frame.end) continue;
    PoseVariable variable;
    variable.node = k;
    variable.frame = graph.frames.size();
    if (starts_window) fill_window(variable, graph, windows[window++], windows.size(), site, config);
    if (k > frame.first) {
      const std::size_t a = graph.poses.size() - 1;
      const Node& before = *graph.nodes[graph.poses[a].node];
      graph.odometry.emplace_back(a, a + 1, before.T_odom_base.inverse() * node.T_odom_base, covariance);
    }
    covariance.setZero();
    if (is_end[k]) graph.pose_of[node.id] = graph.poses.size();
    graph.poses.push_back(variable);
  }
  frame.end_pose = graph.poses.size();
  graph.frames.push_back(frame);
}

/// How the errors of G of two windows that follow each other correlate, axis by axis.
Eigen::Vector3d correlation(const PoseVariable& a, const PoseVariable& b, double seconds,
                            const FleetPlacementConfig& config) {
  Eigen::Vector3d result;
  for (int axis = 0; axis < 3; ++axis) {
    const double scale = 1.0 / config.gps_drift_share;
    const double V_a = scale * a.drift_sigma(axis) * a.drift_sigma(axis);
    const double V_b = scale * b.drift_sigma(axis) * b.drift_sigma(axis);
    result(axis) = share_left(V_a, V_b, kReckoning, seconds, config) * std::sqrt(V_a / V_b);
  }
  return result.cwiseMin(kMaxCorrelation);
}

/// The drift of a robot's GPS goes on when its program starts anew.
void link_drifts(ReducedGraph& graph, const FleetPlacementConfig& config) {
  std::map<AgentId, std::vector<std::size_t>> windows;
  for (std::size_t p = 0; p < graph.poses.size(); ++p) {
    if (graph.poses[p].has_window) windows[graph.nodes[graph.poses[p].node]->id.agent].push_back(p);
  }
  for (auto& [agent, of_agent] : windows) {
    std::ranges::stable_sort(of_agent, {}, [&](std::size_t p) { return graph.poses[p].seconds; });
    for (std::size_t k = 1; k < of_agent.size(); ++k) {
      const std::size_t a = of_agent[k - 1], b = of_agent[k];
      const double seconds = std::max(graph.poses[b].seconds - graph.poses[a].seconds, 0.1);
      graph.drift.push_back({a, b, correlation(graph.poses[a], graph.poses[b], seconds, config)});
    }
  }
}

}  // namespace

BetweenFactor::BetweenFactor(std::size_t from, std::size_t to, const Pose& T_from_to, const Matrix6d& C)
    : a(from), b(to), T_a_b(T_from_to), covariance(C), information(CholeskyOf(C).inverse()) {}

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
  const auto by_frame = [](const Node* node) {
    return std::tie(node->id.agent, node->session, node->id.seq);
  };
  if (!std::ranges::is_sorted(graph.nodes, {}, by_frame)) std::ranges::sort(graph.nodes, {}, by_frame);
  const std::set<NodeId> wanted(ends.begin(), ends.end());
  std::vector<bool> is_end(graph.nodes.size());
  for (std::size_t k = 0; k < graph.nodes.size(); ++k) is_end[k] = wanted.contains(graph.nodes[k]->id);
  for (std::size_t first = 0; first < graph.nodes.size();) {
    std::size_t end = first + 1;
    while (end < graph.nodes.size() && graph.nodes[end]->frame() == graph.nodes[first]->frame()) ++end;
    add_frame(graph, {graph.nodes[first]->frame(), first, end, 0, 0}, is_end, site, config);
    first = end;
  }
  link_drifts(graph, config);
  return graph;
}

}  // namespace fleetmap::graph
