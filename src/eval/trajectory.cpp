#include "fleetmap/eval/trajectory.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace fleetmap::eval {
namespace {

constexpr Duration kLongestGap = std::chrono::seconds(1);

struct Match {
  Pose estimate;
  Pose truth;
};

std::vector<Match> matches_of(const Trajectory& estimate, const Trajectory& truth) {
  std::vector<Match> matches;
  for (const StampedPose& pose : estimate) {
    if (const auto at = pose_at(truth, pose.stamp)) matches.push_back({pose.T_w_base, *at});
  }
  return matches;
}

double rms(double squares, std::size_t count) { return std::sqrt(squares / static_cast<double>(count)); }

struct Positions {
  Eigen::Matrix3Xd estimated, wanted;
};

Positions positions_of(const std::vector<Match>& matches) {
  const auto count = static_cast<Eigen::Index>(matches.size());
  Positions positions{Eigen::Matrix3Xd(3, count), Eigen::Matrix3Xd(3, count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    positions.estimated.col(i) = matches[static_cast<std::size_t>(i)].estimate.translation();
    positions.wanted.col(i) = matches[static_cast<std::size_t>(i)].truth.translation();
  }
  return positions;
}

/// Sum of squared distances after the best rigid transform.
double squares_aligned(const Positions& positions) {
  // About their middles, so that large coordinates do no harm.
  const Eigen::Vector3d middle = positions.wanted.rowwise().mean();
  const Eigen::Matrix3Xd from = positions.estimated.colwise() - middle;
  const Eigen::Matrix3Xd to = positions.wanted.colwise() - middle;
  const Pose T(Eigen::umeyama(from, to, false));
  return (T * from - to).colwise().squaredNorm().sum();
}

void set_ate(TrajectoryErrors& errors, const std::vector<Match>& matches) {
  const Positions positions = positions_of(matches);
  const Eigen::VectorXd squares = (positions.estimated - positions.wanted).colwise().squaredNorm();
  errors.ate_rmse = rms(squares.sum(), matches.size());
  errors.ate_max = std::sqrt(squares.maxCoeff());
  errors.ate_rmse_aligned = rms(squares_aligned(positions), matches.size());
}

/// Geiger et al., KITTI: error of the motion over segments of a given length of the true path.
void set_rpe(TrajectoryErrors& errors, const std::vector<Match>& matches) {
  std::vector<double> path(matches.size(), 0.0);
  for (std::size_t i = 1; i < matches.size(); ++i) {
    path[i] = path[i - 1] + (matches[i].truth.translation() - matches[i - 1].truth.translation()).norm();
  }
  errors.path_length = path.back();
  double translation = 0.0, rotation = 0.0;
  for (std::size_t i = 0, j = 0; i < matches.size(); ++i) {
    while (j < matches.size() && path[j] - path[i] < errors.rpe_length) ++j;
    if (j == matches.size()) break;
    const Pose moved = matches[i].estimate.inverse() * matches[j].estimate;
    const Pose meant = matches[i].truth.inverse() * matches[j].truth;
    const Pose error = meant.inverse() * moved;
    const double length = path[j] - path[i];
    translation += error.translation().norm() / length;
    rotation += so3_log(error.linear()).norm() / length;
    ++errors.rpe_segments;
  }
  errors.rpe_translation = translation / static_cast<double>(errors.rpe_segments);
  errors.rpe_rotation = rotation / static_cast<double>(errors.rpe_segments);
  if (errors.rpe_segments == 0)
    errors.rpe_translation = errors.rpe_rotation = std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::optional<Pose> pose_at(const Trajectory& trajectory, Stamp stamp) {
  const auto after = std::lower_bound(trajectory.begin(), trajectory.end(), stamp,
                                      [](const StampedPose& pose, Stamp t) { return pose.stamp < t; });
  if (after == trajectory.end()) return std::nullopt;
  if (after->stamp == stamp) return after->T_w_base;
  if (after == trajectory.begin()) return std::nullopt;
  const auto before = after - 1;
  const Duration gap = after->stamp - before->stamp;
  if (gap > kLongestGap) return std::nullopt;
  return interpolate(before->T_w_base, after->T_w_base, to_seconds(stamp - before->stamp) / to_seconds(gap));
}

Result<TrajectoryErrors> compare(const Trajectory& estimate, const Trajectory& truth, double rpe_length) {
  if (!(rpe_length > 0.0)) return failure("rpe_length must be positive");
  const std::vector<Match> matches = matches_of(estimate, truth);
  if (matches.size() < 3) {
    return failure("only " + std::to_string(matches.size()) + " of " + std::to_string(estimate.size()) +
                   " poses lie within the truth's times; are both stamped by the same clock?");
  }
  TrajectoryErrors errors;
  errors.pairs = matches.size();
  errors.rpe_length = rpe_length;
  set_ate(errors, matches);
  set_rpe(errors, matches);
  return errors;
}

Result<FleetErrors> compare_jointly(std::span<const Track> tracks) {
  std::vector<Match> all;
  double within = 0.0;
  for (const Track& track : tracks) {
    const std::vector<Match> matches = matches_of(*track.estimate, *track.truth);
    if (matches.size() >= 3) within += squares_aligned(positions_of(matches));
    all.insert(all.end(), matches.begin(), matches.end());
  }
  if (all.size() < 3) {
    return failure("only " + std::to_string(all.size()) +
                   " poses of the fleet lie within the truth's times; are all stamped by the same clock?");
  }
  const Positions positions = positions_of(all);
  const double unaligned = (positions.estimated - positions.wanted).colwise().squaredNorm().sum();
  const double joint = std::min(unaligned, squares_aligned(positions));
  within = std::min(within, joint);
  FleetErrors errors;
  errors.poses = all.size();
  errors.unaligned = rms(unaligned, all.size());
  errors.joint = rms(joint, all.size());
  errors.georeference = rms(unaligned - joint, all.size());
  errors.between_robots = rms(joint - within, all.size());
  errors.within_robots = rms(within, all.size());
  return errors;
}

Result<InterRobotError> compare_pairwise(const Trajectory& a, const Trajectory& b, const Trajectory& truth_a,
                                         const Trajectory& truth_b) {
  InterRobotError result;
  double translation = 0.0, rotation = 0.0;
  for (const StampedPose& pose : a) {
    const auto other = pose_at(b, pose.stamp);
    const auto true_a = pose_at(truth_a, pose.stamp);
    const auto true_b = pose_at(truth_b, pose.stamp);
    if (!other || !true_a || !true_b) continue;
    const Pose T_a_b = pose.T_w_base.inverse() * *other;
    const Pose error = (true_a->inverse() * *true_b).inverse() * T_a_b;
    translation += error.translation().squaredNorm();
    rotation += so3_log(error.linear()).squaredNorm();
    ++result.pairs;
  }
  if (result.pairs == 0) return failure("the robots share no time at which both and their truth are known");
  result.translation_rmse = rms(translation, result.pairs);
  result.rotation_rmse = rms(rotation, result.pairs);
  return result;
}

}  // namespace fleetmap::eval
