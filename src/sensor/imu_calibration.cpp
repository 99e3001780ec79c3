#include "fleetmap/sensor/imu_calibration.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "inertial_motion.hpp"
#include "lidar_track.hpp"
#include "robust_fit.hpp"
#include "standard_gravity.hpp"

namespace fleetmap::sensor {
namespace {

constexpr double kKnotSpacing = 0.45;  // s
constexpr std::size_t kReach = 2;      // knots on either side over which velocities are compared
constexpr std::size_t kMinSteps = 20;
constexpr double kMinTurned = 1.5;                    // rad
constexpr double kMaxDelay = 0.5, kDelayStep = 0.01;  // s
constexpr double kMinAxisTurn = 0.02;                 // rad, of a step that shows the turn axis
// The arm's height shows only in tilting that stands out of the noise: errors of the attitude let gravity
// appear as the acceleration of a high arm.
constexpr double kTiltsAboveNoise = 3.0;

// Parameters of the fit.
enum : Eigen::Index {
  kRotation = 0,
  kGyroBias = 3,
  kDelay = 6,
  kAccelBias = 7,
  kTilt = 10,
  kLever = 12,
  kCount = 15
};

/// The linearisation point of the fit.
struct Start {
  Eigen::Matrix3d R_base_imu = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_base_imu = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias = Eigen::Vector3d::Zero();
  double delay = 0.0;
  Eigen::Matrix3d R_odom_level = Eigen::Matrix3d::Identity();    ///< its z is up
  Eigen::Matrix3d R_base_turning = Eigen::Matrix3d::Identity();  ///< its z is the axis of most turns
};

Eigen::Vector3d rotation_between(const LidarPose& from, const LidarPose& to) {
  return so3_log(from.T_odom_base.linear().transpose() * to.T_odom_base.linear());
}

/// Compares the motions of LiDAR and IMU around the knots of a drive.
class Comparison {
 public:
  Comparison(const CalibrationDrive& drive, std::vector<LidarPose> knots, Start start)
      : imu_(drive.imu), knots_(std::move(knots)), start_(std::move(start)) {
    // The delay moves within a few hundredths of a second of its start, so that what is covered stays so.
    for (std::size_t k = kReach; k + kReach < knots_.size(); ++k) {
      const auto covered =
          integrate(imu_, imu_time(knots_[k - kReach].stamp, start_.delay - 0.1),
                    imu_time(knots_[k + kReach].stamp, start_.delay + 0.1), start_.gyro_bias);
      if (covered && contiguous(k)) steps_.push_back(k);
    }
  }

  std::size_t steps() const { return steps_.size(); }
  const std::vector<LidarPose>& knots() const { return knots_; }
  void set_start(const Start& start) { start_ = start; }

  std::vector<InertialMotion> motions(double delay, const Eigen::Vector3d& gyro_bias) const {
    std::vector<InertialMotion> all(knots_.size());
    for (std::size_t k = 0; k + 1 < knots_.size(); ++k) {
      const auto motion =
          integrate(imu_, imu_time(knots_[k].stamp, delay), imu_time(knots_[k + 1].stamp, delay), gyro_bias);
      if (motion) all[k] = *motion;
    }
    return all;
  }

  /// Gravity's direction by the forces, given the mount.
  Eigen::Vector3d mean_up(const std::vector<InertialMotion>& motions,
                          const Eigen::Matrix3d& R_base_imu) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const std::size_t k : steps_)
      sum += knots_[k].T_odom_base.linear() * R_base_imu * motions[k].velocity;
    return sum;
  }

  /// Rotation of base_link against that of the IMU (rad, three rows), and the change of the LiDAR's mean
  /// velocity against that of the IMU (m/s, three rows), along base_link's axes.
  Eigen::MatrixXd residuals(const Eigen::VectorXd& x) {
    const Eigen::Vector3d gyro_bias = start_.gyro_bias + x.segment<3>(kGyroBias);
    const double delay = start_.delay + x[kDelay];
    if (!cached_ || cached_->first != std::pair(delay, Eigen::Vector3d(gyro_bias)))
      cached_ = {{delay, gyro_bias}, motions(delay, gyro_bias)};
    const auto& motions = cached_->second;
    const Mount mount = mount_at(x);
    Eigen::MatrixXd all(6, static_cast<Eigen::Index>(steps_.size()));
    for (std::size_t step = 0; step < steps_.size(); ++step) {
      const std::size_t k = steps_[step];
      auto column = all.col(static_cast<Eigen::Index>(step));
      const Eigen::Matrix3d R_imu = mount.R * motions[k].R_begin_end * mount.R.transpose();
      const Eigen::Matrix3d R_lidar =
          knots_[k].T_odom_base.linear().transpose() * knots_[k + 1].T_odom_base.linear();
      column.head<3>() = so3_log(R_imu.transpose() * R_lidar);
      column.tail<3>() = velocity_change(k, motions, mount) - inertial_change(k, motions, mount);
    }
    return all;
  }

  Start moved(const Eigen::VectorXd& x) const {
    const Mount mount = mount_at(x);
    Start next = start_;
    next.R_base_imu = mount.R;
    next.p_base_imu = mount.p;
    next.accel_bias = mount.accel_bias;
    next.gyro_bias += x.segment<3>(kGyroBias);
    next.delay += x[kDelay];
    next.R_odom_level = start_.R_odom_level * so3_exp({x[kTilt], x[kTilt + 1], 0.0});
    return next;
  }

 private:
  struct Mount {
    Eigen::Matrix3d R;
    Eigen::Vector3d p, accel_bias, up;
  };
  Mount mount_at(const Eigen::VectorXd& x) const {
    return {so3_exp(x.segment<3>(kRotation)) * start_.R_base_imu,
            start_.p_base_imu + start_.R_base_turning * x.segment<3>(kLever),
            start_.accel_bias + x.segment<3>(kAccelBias),
            start_.R_odom_level * so3_exp({x[kTilt], x[kTilt + 1], 0.0}).col(2)};
  }

  static Stamp imu_time(Stamp lidar, double delay) { return lidar + from_seconds(delay); }

  bool contiguous(std::size_t middle) const {
    for (std::size_t k = middle - kReach; k < middle + kReach; ++k) {
      if (to_seconds(knots_[k + 1].stamp - knots_[k].stamp) > 2.0 * kKnotSpacing) return false;
    }
    return true;
  }

  InertialMotion motion_over(const std::vector<InertialMotion>& motions, std::size_t first) const {
    InertialMotion motion = motions[first];
    for (std::size_t k = 1; k < kReach; ++k) motion = motion.followed_by(motions[first + k]);
    return motion;
  }

  /// The IMU's mean velocity after knot k less that before it, by the LiDAR. The gyro turns the
  /// arm, whose noise is independent of the attitude's, which gravity is compared by.
  Eigen::Vector3d velocity_change(std::size_t k, const std::vector<InertialMotion>& motions,
                                  const Mount& mount) const {
    const LidarPose &first = knots_[k - kReach], &middle = knots_[k], &last = knots_[k + kReach];
    const auto arm_after = [&](const Eigen::Matrix3d& R_imu) {
      return Eigen::Vector3d(mount.R * R_imu * mount.R.transpose() * mount.p);
    };
    const auto way = [&](const LidarPose& from, const LidarPose& to) {
      return Eigen::Vector3d(middle.T_odom_base.linear().transpose() *
                             (to.T_odom_base.translation() - from.T_odom_base.translation()));
    };
    const Eigen::Vector3d before = arm_after(motion_over(motions, k - kReach).R_begin_end.transpose());
    const Eigen::Vector3d after = arm_after(motion_over(motions, k).R_begin_end);
    return (way(middle, last) + after - mount.p) / to_seconds(last.stamp - middle.stamp) -
           (way(first, middle) + mount.p - before) / to_seconds(middle.stamp - first.stamp);
  }

  Eigen::Vector3d inertial_change(std::size_t k, const std::vector<InertialMotion>& motions,
                                  const Mount& mount) const {
    const InertialMotion before = motion_over(motions, k - kReach), after = motion_over(motions, k);
    const auto mean = [&](const InertialMotion& motion) {
      return Eigen::Vector3d((motion.displacement - motion.displacement_by_bias * mount.accel_bias) /
                             motion.seconds);
    };
    const Eigen::Vector3d gained = before.velocity - before.velocity_by_bias * mount.accel_bias;
    const Eigen::Vector3d change = before.R_begin_end.transpose() * (gained - mean(before)) + mean(after);
    const Eigen::Vector3d up_base = knots_[k].T_odom_base.linear().transpose() * mount.up;
    return mount.R * change - 0.5 * (before.seconds + after.seconds) * kStandardGravity * up_base;
  }

  const std::vector<Imu>& imu_;
  std::vector<LidarPose> knots_;
  Start start_;
  std::vector<std::size_t> steps_;  ///< knots at which both are compared
  std::optional<std::pair<std::pair<double, Eigen::Vector3d>, std::vector<InertialMotion>>> cached_;
};

/// The delay at which the sizes of the rotations agree best, whatever the mount is.
double delay_by_turn_rates(const std::vector<Imu>& imu, const std::vector<LidarPose>& knots) {
  std::vector<Eigen::Vector3d> turned(imu.size(), Eigen::Vector3d::Zero());  // up to each sample
  for (std::size_t k = 1; k < imu.size(); ++k) {
    turned[k] = turned[k - 1] + 0.5 * to_seconds(imu[k].stamp - imu[k - 1].stamp) *
                                    (imu[k].angular_velocity + imu[k - 1].angular_velocity);
  }
  const auto until = [&](Stamp stamp) {
    const auto after = std::ranges::lower_bound(imu, stamp, {}, &Imu::stamp);
    if (after == imu.begin()) return turned.front();
    if (after == imu.end()) return turned.back();
    const auto k = static_cast<std::size_t>(after - imu.begin());
    const double share = to_seconds(stamp - imu[k - 1].stamp) / to_seconds(imu[k].stamp - imu[k - 1].stamp);
    return Eigen::Vector3d(turned[k - 1] + share * (turned[k] - turned[k - 1]));
  };
  double best = 0.0, min_misfit = std::numeric_limits<double>::infinity();
  for (double delay = -kMaxDelay; delay <= kMaxDelay; delay += kDelayStep) {
    const Duration shift = from_seconds(delay);
    double misfit = 0.0;
    for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
      const double by_imu = (until(knots[k + 1].stamp + shift) - until(knots[k].stamp + shift)).norm();
      misfit += std::abs(by_imu - rotation_between(knots[k], knots[k + 1]).norm());
    }
    if (misfit < min_misfit) {
      min_misfit = misfit;
      best = delay;
    }
  }
  return best;
}

/// Turns from knot to knot about axes that are square to `axis`, rad RMS.
double tilting(const std::vector<LidarPose>& knots, const Eigen::Vector3d& axis) {
  double squares = 0.0;
  for (std::size_t k = 0; k + 1 < knots.size(); ++k)
    squares += rotation_between(knots[k], knots[k + 1]).cross(axis).squaredNorm();
  return std::sqrt(0.5 * squares / static_cast<double>(knots.size()));
}

/// Rotation by which the IMU's turns become those of base_link; about the mean turn axis it is arbitrary.
struct TurnFit {
  Eigen::Matrix3d R_base_imu;
  Eigen::Vector3d axis;  ///< in base_link, the direction of most turning
};

/// After Kabsch (Acta Crystallographica 1976).
TurnFit fit_turns(const std::vector<LidarPose>& knots, const std::vector<InertialMotion>& motions) {
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero(), squares = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
    const Eigen::Vector3d base = rotation_between(knots[k], knots[k + 1]),
                          imu = so3_log(motions[k].R_begin_end);
    if (base.norm() < kMinAxisTurn || imu.norm() < kMinAxisTurn) continue;
    products += base * imu.transpose();
    squares += base * base.transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(products, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs(1.0, 1.0,
                        (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0);
  const Eigen::JacobiSVD<Eigen::Matrix3d> axes(squares, Eigen::ComputeFullU);
  return {svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose(), axes.matrixU().col(0)};
}

FitProblem problem_of(Comparison& comparison, bool with_height) {
  FitProblem problem;
  problem.residuals = [&comparison](const Eigen::VectorXd& x) { return comparison.residuals(x); };
  problem.group_of_row = {0, 0, 1, 2, 2, 3};
  problem.min_noise = {1e-5, 1e-5, 1e-4, 1e-4};
  problem.start = Eigen::VectorXd::Zero(kCount);
  problem.prior_sigma = Eigen::VectorXd(kCount);
  problem.prior_sigma << 1.0, 1.0, 1.0, 0.1, 0.1, 0.1, 0.1, 0.5, 0.5, 0.5, 0.5, 0.5, 1.0, 1.0,
      with_height ? 1.0 : 1e-3;
  problem.correlated_steps = 2 * kReach + 2;
  return problem;
}

ImuCalibration calibration_of(const Start& start, const FitResult& fit) {
  ImuCalibration found;
  found.T_base_imu = make_pose(start.R_base_imu, start.p_base_imu);
  const Eigen::MatrixXd& C = fit.covariance;
  const Eigen::Matrix3d& A = start.R_base_turning;
  found.covariance.topLeftCorner<3, 3>() = A * C.block<3, 3>(kLever, kLever) * A.transpose();
  found.covariance.bottomRightCorner<3, 3>() = C.block<3, 3>(kRotation, kRotation);
  found.covariance.topRightCorner<3, 3>() = A * C.block<3, 3>(kLever, kRotation);
  found.covariance.bottomLeftCorner<3, 3>() = C.block<3, 3>(kRotation, kLever) * A.transpose();
  found.delay = {start.delay, std::sqrt(C(kDelay, kDelay))};
  found.gyro_bias = start.gyro_bias;
  found.accel_bias = start.accel_bias;
  return found;
}

}  // namespace

Result<ImuCalibration> calibrate_imu(const CalibrationDrive& drive, const Pose& expected) {
  if (drive.imu.empty()) return failure("no IMU samples");
  std::vector<LidarPose> knots = lidar_knots(drive.track, kKnotSpacing);
  if (turned(knots) < kMinTurned) return failure("the robot hardly turned");
  const double delay = delay_by_turn_rates(drive.imu, knots);
  Start rough;
  rough.delay = delay;
  rough.p_base_imu = expected.translation();
  Comparison comparison(drive, std::move(knots), rough);
  if (comparison.steps() < kMinSteps) return failure("the IMU's samples cover less than 10 s of the drive");
  const auto motions = comparison.motions(delay, Eigen::Vector3d::Zero());
  const TurnFit turns = fit_turns(comparison.knots(), motions);
  std::optional<std::pair<Start, FitResult>> best;
  for (int quarter = 0; quarter < 4; ++quarter) {
    Start start = rough;
    start.R_base_imu = so3_exp(0.5 * std::numbers::pi * quarter * turns.axis) * turns.R_base_imu;
    start.R_base_turning = levelling(turns.axis).transpose();
    start.R_odom_level = levelling(comparison.mean_up(motions, start.R_base_imu)).transpose();
    comparison.set_start(start);
    const FitResult first = robust_fit(problem_of(comparison, false));
    if (!best || first.misfit < best->second.misfit) best = {comparison.moved(first.parameters), first};
  }
  // Once more from the result, whose covariance is then that of small rotations.
  comparison.set_start(best->first);
  const bool with_height =
      tilting(comparison.knots(), turns.axis) > kTiltsAboveNoise * best->second.noise.front();
  const FitResult fit = robust_fit(problem_of(comparison, with_height));
  ImuCalibration found = calibration_of(comparison.moved(fit.parameters), fit);
  if (!with_height) found.covariance.topLeftCorner<3, 3>() += turns.axis * turns.axis.transpose();  // m^2
  return found;
}

}  // namespace fleetmap::sensor
