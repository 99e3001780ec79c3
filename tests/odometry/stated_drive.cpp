#include "odometry/stated_drive.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "fleetmap/odometry/loam.hpp"
#include "fleetmap/odometry/motion_covariance.hpp"
#include "fleetmap/odometry/trajectory_check.hpp"

namespace fleetmap::testing {
namespace {

constexpr std::size_t kPiece = 30;  // scans of which an error and its covariance are compared

/// The robot stands on the ground: its height and slope are added to the motion on level ground.
Pose on_ground(const GroundShape& ground, const Pose& level) {
  if (!ground.height) return level;
  constexpr double kStance = 0.2;  // m, half of what the wheels span
  const double x = level.translation().x(), y = level.translation().y();
  const double dx = (ground.height(x + kStance, y) - ground.height(x - kStance, y)) / (2.0 * kStance);
  const double dy = (ground.height(x, y + kStance) - ground.height(x, y - kStance)) / (2.0 * kStance);
  Pose T = level;
  T.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), Eigen::Vector3d(-dx, -dy, 1.0)) *
               level.linear();
  T.translation().z() += ground.height(x, y);
  return T;
}

/// Errors and what is stated for them, along the drive.
class ErrorStatistics {
 public:
  void add(const odometry::OdometryUpdate& update, const Pose& truth) {
    check_.add(update);
    piece_.add(update);
    estimate_.push_back(update.T_odom_base);
    truth_.push_back(truth);
    if (estimate_.size() % kPiece != 1 || estimate_.size() == 1) return;
    const Vector6d error = error_since(estimate_.size() - 1 - kPiece);
    const double nees = error.dot(piece_.since_reference().ldlt().solve(error)) / 6.0;
    sum_ += nees;
    worst_ = std::max(worst_, nees);
    ++pieces_;
    piece_.restart();
  }

  void fill(StatedDrive& result) const {
    if (estimate_.empty()) return;
    result.error = error_since(0).head<3>().norm();
    result.sigma = std::sqrt(check_.covariance().topLeftCorner<3, 3>().trace());
    result.nees = sum_ / pieces_;
    result.worst_nees = worst_;
    result.warned = result.warned || !check_.warnings().empty();
  }

 private:
  Vector6d error_since(std::size_t from) const {
    return se3_log((truth_[from].inverse() * truth_.back()).inverse() *
                   (estimate_[from].inverse() * estimate_.back()));
  }

  odometry::TrajectoryCheck check_;
  odometry::MotionCovariance piece_;
  std::vector<Pose> estimate_, truth_;
  double sum_ = 0.0, worst_ = 0.0;
  int pieces_ = 0;
};

}  // namespace

GroundShape rolling_ground(double height, double rough) {
  const auto wave = [](double length) { return 2.0 * std::numbers::pi / length; };
  const double a = wave(45.0), b = wave(31.0), c = wave(0.7), d = wave(1.3), e = wave(2.9);
  return {[=](double x, double y) {
            const double rolls = std::sin(a * x + 0.3 * b * y) + std::sin(b * y - 0.4 * a * x);
            const double bumps =
                std::sin(c * x + 0.8 * c * y) + std::sin(d * y - 0.6 * d * x) + std::sin(e * x + 0.5 * e * y);
            return 0.5 * (height * rolls + rough * bumps);
          },
          height * (a + b) + 0.65 * rough * (c + d + e)};
}

std::vector<DriveLeg> errands() {
  return {{1, 0, 0}, {10, 1.5, 0}, {4, 1.2, 0.4},  {3, 0, 0},      {4, 0, 1.0},
          {1, 0, 0}, {2, 0, -1.0}, {8, 1.5, -0.1}, {4, 1.0, -0.5}, {3, 1.5, 0}};
}

PoorDrive drive_in(SyntheticWorld world) {
  PoorDrive drive;
  drive.world = std::move(world);
  return drive;
}

PoorDrive drive_on(GroundShape ground) {
  PoorDrive drive;
  drive.world.set_ground(std::move(ground));
  return drive;
}

StatedDrive state_drive(const PoorDrive& drive, bool gyro_and_wheels, std::uint64_t seed) {
  const SyntheticDrive motion(drive.legs);
  const PoseAt pose_at = [&](double t) { return on_ground(drive.world.ground(), motion.at(t)); };
  const ScanOptions options{.noise = drive.noise, .seed = seed};
  odometry::LoamConfig config;
  config.T_base_lidar = options.T_base_lidar;
  odometry::Loam loam(config, drive.model);
  ErrorStatistics statistics;
  StatedDrive result;
  double fed = 0.0;
  for (; 0.1 * (result.scans + 1) < motion.duration(); ++result.scans) {
    const double now = 0.1 * result.scans;
    for (; gyro_and_wheels && fed < now + 0.12; fed += 0.01) {
      sensor::Imu imu = motion.imu(fed);
      imu.angular_velocity =
          so3_log(pose_at(fed - 1e-3).linear().transpose() * pose_at(fed + 1e-3).linear()) / 2e-3;
      loam.add_imu(imu);
      sensor::Wheel wheel = motion.wheel(fed);
      wheel.forward_speed *= drive.wheel_scale;
      loam.add_wheel(wheel);
    }
    sensor::Scan scan = make_scan(drive.world, pose_at, now, drive.model, options);
    std::erase_if(scan.points, [&](const sensor::ScanPoint& p) { return !drive.keep(p); });
    const auto update = loam.add_scan(scan);
    result.refused += !update;
    if (!update) continue;
    result.degenerate += update->degenerate_count > 0;
    statistics.add(*update, pose_at(now));
  }
  result.lost = loam.counters().lost;
  result.warned = loam.counters().map_restarts > 0;
  statistics.fill(result);
  return result;
}

}  // namespace fleetmap::testing
