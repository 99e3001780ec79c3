#include "fleetmap/sensor/antenna_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "fleetmap/geometry/geodesy.hpp"
#include "lidar_track.hpp"
#include "robust_fit.hpp"

namespace fleetmap::sensor {
namespace {

constexpr double kFixWindow = 8.0;  // s
constexpr std::size_t kMinInWindow = 4, kMinFixes = 20;
constexpr double kMinAntennaTurn = 1.5, kTurnSpacing = 4.0;  // rad, s
constexpr double kVelocityReach = 0.25;                      // s

enum : Eigen::Index { kHeading = 0, kArm = 3, kLate = 6, kStretch = 7, kAntennaCount = 8 };

struct TrackMoment {
  Stamp stamp;
  Eigen::Vector3d p_enu;
  Pose T_odom_base;
  Eigen::Vector3d velocity, turn_rate;  ///< m/s in the odometry's frame, rad/s in base_link

  /// The antenna's place `late` s before. Velocities are those over half a second: between two scans the
  /// noise of both would be in the velocity and in the place alike, and would bias the delay. `stretch`: by
  /// which the track is too short.
  Eigen::Vector3d antenna(const Eigen::Vector3d& arm, double late, double stretch) const {
    return (1.0 + stretch) * T_odom_base.translation() - late * velocity +
           T_odom_base.linear() * so3_exp(-late * turn_rate) * arm;
  }
};
using Window = std::vector<TrackMoment>;

std::optional<TrackMoment> moment_of(const std::vector<LidarPose>& track, Stamp stamp) {
  const Duration reach = from_seconds(kVelocityReach);
  const auto before = pose_at(track, stamp - reach), at = pose_at(track, stamp),
             after = pose_at(track, stamp + reach);
  if (!before || !at || !after) return std::nullopt;
  const double seconds = 2.0 * kVelocityReach;
  return TrackMoment{stamp, Eigen::Vector3d::Zero(), *at,
                     (after->translation() - before->translation()) / seconds,
                     so3_log(before->linear().transpose() * after->linear()) / seconds};
}

/// Fixes that the track covers, cut into windows.
std::vector<Window> windows_of(const CalibrationDrive& drive) {
  std::vector<Window> windows;
  std::optional<LocalFrame> frame;
  for (const Fix& fix : drive.fixes) {
    if (!fix.valid || !is_valid(fix.position)) continue;
    auto place = moment_of(drive.track, fix.stamp);
    if (!place) continue;
    if (!frame) frame.emplace(fix.position);
    place->p_enu = frame->to_enu(fix.position);
    if (windows.empty() || to_seconds(fix.stamp - windows.back().front().stamp) > kFixWindow)
      windows.emplace_back();
    windows.back().push_back(*place);
  }
  std::erase_if(windows, [](const Window& window) { return window.size() < kMinInWindow; });
  return windows;
}

Eigen::Matrix3Xd less_mean(const Eigen::Matrix3Xd& places) {
  return places.colwise() - Eigen::Vector3d(places.rowwise().mean());
}

/// Places by GPS, those of a window less their mean.
Eigen::Matrix3Xd measured(const Window& window) {
  Eigen::Matrix3Xd places(3, static_cast<Eigen::Index>(window.size()));
  for (std::size_t k = 0; k < window.size(); ++k) places.col(static_cast<Eigen::Index>(k)) = window[k].p_enu;
  return less_mean(places);
}

/// The same of an antenna that the LiDAR's track carries, in the odometry's frame.
Eigen::Matrix3Xd carried(const Window& window, const Eigen::Vector3d& arm, double late, double stretch) {
  Eigen::Matrix3Xd places(3, static_cast<Eigen::Index>(window.size()));
  for (std::size_t k = 0; k < window.size(); ++k)
    places.col(static_cast<Eigen::Index>(k)) = window[k].antenna(arm, late, stretch);
  return less_mean(places);
}

/// The heading of the odometry's frame in ENU that fits the tracks best, rad.
double heading_of(const std::vector<Window>& windows, const Eigen::Vector3d& arm) {
  double dot = 0.0, cross = 0.0;
  for (const Window& window : windows) {
    const Eigen::Matrix3Xd enu = measured(window), odom = carried(window, arm, 0.0, 0.0);
    dot += odom.topRows<2>().cwiseProduct(enu.topRows<2>()).sum();
    cross += odom.row(0).dot(enu.row(1)) - odom.row(1).dot(enu.row(0));
  }
  return std::atan2(cross, dot);
}

}  // namespace

Result<AntennaCalibration> calibrate_antenna(const CalibrationDrive& drive, const Eigen::Vector3d& expected) {
  if (drive.fixes.empty()) return failure("no fixes");
  const std::vector<Window> windows = windows_of(drive);
  std::size_t fixes = 0;
  for (const Window& window : windows) fixes += window.size();
  if (fixes < kMinFixes) return failure("less than " + std::to_string(kMinFixes) + " fixes during the drive");
  if (turned(lidar_knots(drive.track, kTurnSpacing)) < kMinAntennaTurn)
    return failure("the robot hardly turned");
  const Eigen::Matrix3d R_enu_odom = rotation_from_rpy(0.0, 0.0, heading_of(windows, expected));
  FitProblem problem;
  problem.residuals = [&](const Eigen::VectorXd& x) {
    const Eigen::Matrix3d R = so3_exp(x.segment<3>(kHeading)) * R_enu_odom;
    Eigen::MatrixXd all(3, static_cast<Eigen::Index>(fixes));
    Eigen::Index first = 0;
    for (const Window& window : windows) {
      const auto count = static_cast<Eigen::Index>(window.size());
      all.middleCols(first, count) =
          R * carried(window, expected + x.segment<3>(kArm), x[kLate], x[kStretch]) - measured(window);
      first += count;
    }
    return all;
  };
  problem.group_of_row = {0, 0, 1};
  problem.min_noise = {1e-3, 1e-3};
  problem.start = Eigen::VectorXd::Zero(kAntennaCount);
  problem.prior_sigma = Eigen::VectorXd(kAntennaCount);
  problem.prior_sigma << 0.3, 0.3, 1.0, 2.0, 2.0, 2.0, 0.2, 0.03;
  problem.correlated_steps = fixes / windows.size();
  const FitResult fit = robust_fit(problem);
  return AntennaCalibration{expected + fit.parameters.segment<3>(kArm),
                            fit.covariance.block<3, 3>(kArm, kArm),
                            {fit.parameters[kLate], std::sqrt(fit.covariance(kLate, kLate))}};
}

}  // namespace fleetmap::sensor
