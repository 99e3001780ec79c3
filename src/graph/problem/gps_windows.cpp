#include "problem/gps_windows.hpp"

#include <algorithm>
#include <cmath>

#include "fleetmap/geometry/portable_math.hpp"

namespace fleetmap::graph {
namespace {

constexpr std::size_t kMaxWindowNodes = 16;
constexpr double kMaxSigma = 1e3;             // m; a larger one is no fix
constexpr double kMinRestVariance = 0.01;     // m^2, of a window's mean fix
constexpr double kMinTiltVariance = 2.5e-7;   // rad^2, (0.03 deg)^2
constexpr double kMaxRotationVariance = 4.0;  // rad^2
/// Variance that a filter adds per second of dead reckoning by wheels and gyro.
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

Vector6d variance_of(const Node& node) {
  Vector6d variance = node.G->covariance.diagonal();
  variance.head<3>() = variance.head<3>().cwiseMax(1e-6).cwiseMin(kMaxSigma * kMaxSigma);
  variance.tail<3>() = variance.tail<3>().cwiseMax(kMinTiltVariance).cwiseMin(kMaxRotationVariance);
  return variance;
}

/// True if the window holds no fix: without fixes the variances of height and heading only grow. Those of
/// east and north may shrink when the robot returns to a position of small heading error, but not below
/// `least`.
bool is_dead_reckoned(const GpsWindow& window, const Vector6d& min_variance) {
  return window.variance(2) > window.before(2) && window.variance(5) > window.before(5) &&
         window.variance.head<2>().sum() > min_variance.head<2>().sum();
}

/// Share of a filter's error in one axis that remains after some time. Its variance V_a grows by dead
/// reckoning until fixes reduce it to V_b; without fixes the whole error remains. The drift of the fixes
/// themselves remains as well, even if the filter does not model it.
double remaining_share(double V_a, double V_b, double reckoning, double seconds,
                       const FleetPlacementConfig& config) {
  const double drift = portable::exp(-seconds / config.gps_correlation_time);
  const double left = std::max(drift, V_b / (V_a + reckoning * seconds));
  return std::min(left, std::min(1.0, V_b / V_a));
}

/// Variance of the heading of G without its correlation with the window before, because its error is no
/// variable.
double heading_variance(const GpsWindow& window, const FleetPlacementConfig& config) {
  const double V_a = window.before(5), V_b = window.variance(5);
  if (V_a == 0.0) return V_b;
  const double left = remaining_share(V_a, V_b, kReckoningTurn, window.seconds, config);
  const double information = (1.0 - left) * (1.0 - left) / std::max(V_b - left * left * V_a, 1e-3 * V_b);
  return 1.0 / std::max(information, 1.0 / kMaxRotationVariance);
}

/// Variance of the position in a window by an error of G's heading that lasts longer than the window. It
/// rotates each window's track alike, so it is multiplied by the number of windows that share it, `windows`
/// at most. It is capped by the filter's variance of the position, which contains its heading error.
Eigen::Vector3d variance_by_heading(const GpsWindow& window, const Eigen::Vector3d& moved_enu, double seconds,
                                    std::size_t windows) {
  const double lasts = window.variance(5) / kReckoningTurn;  // s
  const double shared = std::clamp(lasts / std::max(1.0, seconds), 1.0, static_cast<double>(windows));
  const Eigen::Vector3d across(moved_enu.y(), moved_enu.x(), 0.0);
  const Eigen::Vector3d by_heading = window.variance(5) * across.cwiseAbs2();
  return shared * by_heading.cwiseMin(window.variance.head<3>());
}

}  // namespace

std::vector<GpsWindow> gps_windows(std::span<const Node* const> nodes, const FrameSpan& frame,
                                   const FleetPlacementConfig& config) {
  std::vector<GpsWindow> windows{{.first = frame.first}};
  Step since;
  for (std::size_t k = frame.first + 1; k < frame.end; ++k) {
    const Step step = between(*nodes[k - 1], *nodes[k]);
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
  std::vector<GpsWindow> fixed;
  for (GpsWindow& window : windows) {
    for (std::size_t k = window.first; k < window.end; ++k)
      window.variance += variance_of(*nodes[k]) / static_cast<double>(window.end - window.first);
    window.best = window.variance.head<3>();
    if (&window != &windows.front()) {
      const GpsWindow& before = *(&window - 1);
      window.before = before.variance;
      window.best = window.best.cwiseMin((before.best.array() + kReckoning * window.seconds).matrix());
    }
    if (fixed.empty() || !is_dead_reckoned(window, fixed.back().variance)) fixed.push_back(window);
  }
  return fixed;
}

PoseVariable with_window(PoseVariable variable, std::span<const Node* const> nodes, const GpsWindow& window,
                         std::size_t windows, const LocalFrame& site, const FleetPlacementConfig& config) {
  const Node& anchor = *nodes[variable.node];
  const Pose T_base_odom = anchor.T_odom_base.inverse();
  const double count = static_cast<double>(window.end - window.first);
  for (std::size_t k = window.first; k < window.end; ++k) {
    const Node& node = *nodes[k];
    variable.lever += T_base_odom * Eigen::Vector3d(node.T_odom_base.translation());
    variable.fix += site.to_enu(node.G->position);
  }
  variable.has_window = true;
  variable.lever /= count;
  variable.fix /= count;
  variable.seconds = to_seconds(anchor.stamp - nodes.front()->stamp);
  const Node& last = *nodes[window.end - 1];
  const double seconds = std::abs(to_seconds(last.stamp - anchor.stamp));
  variable.R_enu_base = pose_in(site, *anchor.G).linear();
  const Eigen::Vector3d moved =
      variable.R_enu_base * (T_base_odom * Eigen::Vector3d(last.T_odom_base.translation()));
  const Eigen::Vector3d drift = config.gps_drift_share * window.best;
  variable.drift_sigma = drift.cwiseSqrt();
  variable.rest_variance =
      window.variance.head<3>() - drift + variance_by_heading(window, moved, seconds, windows);
  variable.rest_variance.array() += kMinRestVariance;
  // Roll and pitch errors drift as well: nodes closer in time than the correlation time share them.
  const double shared = std::max(1.0, config.gps_correlation_time / std::max(1.0, seconds));
  const Vector6d of_anchor = variance_of(anchor);
  variable.rotation_variance << shared * of_anchor.segment<2>(3), heading_variance(window, config);
  variable.rotation_variance = variable.rotation_variance.cwiseMin(kMaxRotationVariance);
  return variable;
}

Eigen::Vector3d drift_correlation(const PoseVariable& a, const PoseVariable& b, double seconds,
                                  const FleetPlacementConfig& config) {
  Eigen::Vector3d result;
  for (int axis = 0; axis < 3; ++axis) {
    const double scale = 1.0 / config.gps_drift_share;
    const double V_a = scale * a.drift_sigma(axis) * a.drift_sigma(axis);
    const double V_b = scale * b.drift_sigma(axis) * b.drift_sigma(axis);
    result(axis) = remaining_share(V_a, V_b, kReckoning, seconds, config) * std::sqrt(V_a / V_b);
  }
  return result.cwiseMin(kMaxCorrelation);
}

}  // namespace fleetmap::graph
