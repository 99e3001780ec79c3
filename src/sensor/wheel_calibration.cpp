#include "fleetmap/sensor/wheel_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "robust_fit.hpp"

namespace fleetmap::sensor {
namespace {

constexpr double kWheelStepTime = 0.95;  // s
constexpr Duration kMaxWheelGap = std::chrono::milliseconds(500);
constexpr std::size_t kMinWheelSteps = 15;
constexpr double kMinDriven = 5.0;          // m
constexpr double kMinTurnedByWheels = 1.5;  // rad, that show a lever arm: less is noise
// A body that sways comes back: what it turns in one step is undone in those after it.
constexpr std::size_t kSwaySteps = 8;

enum : Eigen::Index { kWheelTurn = 0, kOffset = 3, kScale = 6, kWheelCount = 7 };

/// A step of the drive, in base_link at its begin.
struct Step {
  Pose T_begin_end;
  struct Part {
    double driven;  ///< m, by the wheels
    Eigen::Matrix3d R_begin_part;
  };
  std::vector<Part> parts;  ///< from scan to scan
};

/// m that the wheels drove; empty if their samples do not cover the time.
std::optional<double> driven(const std::vector<Wheel>& wheels, Stamp begin, Stamp end) {
  auto after = std::ranges::upper_bound(wheels, begin, {}, &Wheel::stamp);
  if (after == wheels.begin() || wheels.empty() || wheels.back().stamp < end) return std::nullopt;
  const auto speed = [](const Wheel& before, const Wheel& next, Stamp at) {
    const double share = to_seconds(at - before.stamp) / to_seconds(next.stamp - before.stamp);
    return before.forward_speed + share * (next.forward_speed - before.forward_speed);
  };
  double sum = 0.0;
  for (Stamp at = begin; at < end; ++after) {
    const Wheel& before = *std::prev(after);
    if (after == wheels.end() || after->stamp - before.stamp > kMaxWheelGap) return std::nullopt;
    const Stamp until = std::min(end, after->stamp);
    sum += 0.5 * to_seconds(until - at) * (speed(before, *after, at) + speed(before, *after, until));
    at = until;
  }
  return sum;
}

/// From pose `first` on; empty if the wheels or the scans have a gap. `last` becomes the pose at its end.
std::optional<Step> step_from(const CalibrationDrive& drive, std::size_t first, std::size_t last) {
  Step step;
  const Pose T_begin_odom = drive.track[first].T_odom_base.inverse();
  for (std::size_t k = first; k < last; ++k) {
    const LidarPose &from = drive.track[k], &to = drive.track[k + 1];
    const auto metres = driven(drive.wheels, from.stamp, to.stamp);
    if (!metres || to.stamp - from.stamp > kMaxWheelGap) return std::nullopt;
    const Pose T_odom_middle = interpolate(from.T_odom_base, to.T_odom_base, 0.5);
    step.parts.push_back({*metres, T_begin_odom.linear() * T_odom_middle.linear()});
  }
  step.T_begin_end = T_begin_odom * drive.track[last].T_odom_base;
  return step;
}

std::vector<Step> steps_of(const CalibrationDrive& drive) {
  std::vector<Step> steps;
  std::size_t first = 0;
  for (std::size_t k = 1; k < drive.track.size(); ++k) {
    if (to_seconds(drive.track[k].stamp - drive.track[first].stamp) < kWheelStepTime) continue;
    if (auto step = step_from(drive, first, k)) steps.push_back(std::move(*step));
    first = k;
  }
  return steps;
}

double driven(const Step& step) {
  double sum = 0.0;
  for (const Step::Part& part : step.parts) sum += part.driven;
  return sum;
}

/// rad about z, of all steps.
double turned(const std::vector<Step>& steps) {
  double sum = 0.0;
  for (const Step& step : steps) sum += std::abs(so3_log(step.T_begin_end.linear()).z());
  return sum;
}

/// Rows: error of the place of base_link (m, three), and turns about its x and y axes (rad).
Eigen::Matrix<double, 5, 1> residual(const Step& step, const Eigen::Matrix3d& R_wheels_base,
                                     const Eigen::VectorXd& x) {
  const auto in_wheels = [&](const Eigen::Matrix3d& R) {
    return Eigen::Matrix3d(R_wheels_base * R * R_wheels_base.transpose());
  };
  Eigen::Vector3d way = Eigen::Vector3d::Zero();
  for (const Step::Part& part : step.parts) way += part.driven * in_wheels(part.R_begin_part).col(0);
  const Eigen::Matrix3d R = in_wheels(step.T_begin_end.linear());
  const Eigen::Vector3d offset = x.segment<3>(kOffset);
  Eigen::Matrix<double, 5, 1> e;
  // The point about which a body sways is not known, so only turns about z show the lever arm.
  const Eigen::Matrix3d R_yaw = so3_exp({0.0, 0.0, so3_log(R).z()});
  e.head<3>() =
      R_wheels_base * step.T_begin_end.translation() - way / (1.0 + x[kScale]) - (R_yaw * offset - offset);
  e.tail<2>() = so3_log(R).head<2>();
  return e;
}

/// Yaw by which base_link must turn to face the way that the wheels drive, rad.
double yaw_of(const std::vector<Step>& steps) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Step& step : steps) {
    // The middle of the step has the direction of its chord.
    const Eigen::Matrix3d& R = step.parts[step.parts.size() / 2].R_begin_part;
    sum += driven(step) * (R.transpose() * step.T_begin_end.translation()).head<2>();
  }
  return -std::atan2(sum.y(), sum.x());
}

}  // namespace

Result<WheelCalibration> calibrate_wheels(const CalibrationDrive& drive) {
  if (drive.wheels.empty()) return failure("no wheel odometry");
  const std::vector<Step> steps = steps_of(drive);
  double metres = 0.0;
  for (const Step& step : steps) metres += std::abs(driven(step));
  if (steps.size() < kMinWheelSteps || metres < kMinDriven) return failure("the wheels drove less than 5 m");
  const Eigen::Matrix3d R_start = rotation_from_rpy(0.0, 0.0, yaw_of(steps));
  FitProblem problem;
  problem.residuals = [&](const Eigen::VectorXd& x) {
    const Eigen::Matrix3d R = so3_exp(x.segment<3>(kWheelTurn)) * R_start;
    Eigen::MatrixXd all(5, static_cast<Eigen::Index>(steps.size()));
    for (std::size_t k = 0; k < steps.size(); ++k)
      all.col(static_cast<Eigen::Index>(k)) = residual(steps[k], R, x);
    return all;
  };
  problem.group_of_row = {0, 1, 2, 3, 3};
  problem.min_noise = {1e-4, 1e-4, 1e-4, 1e-5};
  problem.start = Eigen::VectorXd::Zero(kWheelCount);
  problem.prior_sigma = Eigen::VectorXd(kWheelCount);
  problem.prior_sigma << 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.5;
  problem.correlated_steps = kSwaySteps;
  const FitResult fit = robust_fit(problem);
  WheelCalibration found;
  found.T_wheels_base =
      make_pose(so3_exp(fit.parameters.segment<3>(kWheelTurn)) * R_start, fit.parameters.segment<3>(kOffset));
  const Eigen::MatrixXd& C = fit.covariance;
  found.covariance.topLeftCorner<3, 3>() = C.block<3, 3>(kOffset, kOffset);
  found.covariance.bottomRightCorner<3, 3>() = C.block<3, 3>(kWheelTurn, kWheelTurn);
  found.covariance.topRightCorner<3, 3>() = C.block<3, 3>(kOffset, kWheelTurn);
  found.covariance.bottomLeftCorner<3, 3>() = C.block<3, 3>(kWheelTurn, kOffset);
  if (turned(steps) < kMinTurnedByWheels) found.covariance.diagonal().head<2>().array() += 1.0;  // m^2
  found.speed_scale = {1.0 + fit.parameters[kScale], std::sqrt(C(kScale, kScale))};
  return found;
}

}  // namespace fleetmap::sensor
