#include "fleetmap/agent/level_track.hpp"

#include <algorithm>

namespace fleetmap::agent {
namespace {

constexpr double kMemory = 60.0;  // s; the odometry's own tilt drifts by less in that time

}  // namespace

void LevelTrack::add(const Eigen::Vector3d& up_in_base, const Pose& T_odom_base, Stamp stamp) {
  const Eigen::Vector3d up = T_odom_base.linear() * up_in_base;
  if (!up.allFinite()) return;
  if (!up_in_odom_) {
    up_in_odom_ = up;
    first_ = last_ = stamp;
    return;
  }
  const double step = to_seconds(stamp - last_), age = to_seconds(stamp - first_);
  if (!(step > 0.0)) return;
  // The plain mean of all until the memory is full.
  const double weight = step / std::min(kMemory, age);
  *up_in_odom_ = ((1.0 - weight) * *up_in_odom_ + weight * up).normalized();
  last_ = stamp;
}

Eigen::Vector3d LevelTrack::up_in_base(const Pose& T_odom_base) const {
  const Eigen::Vector3d up = up_in_odom_.value_or(Eigen::Vector3d::UnitZ());
  return (T_odom_base.linear().transpose() * up).normalized();
}

GlobalPose levelled(const GlobalPose& G, const Eigen::Vector3d& up_in_base) {
  const Eigen::Vector3d up = G.q_enu_base.conjugate() * Eigen::Vector3d::UnitZ();
  GlobalPose turned = G;
  turned.q_enu_base = (G.q_enu_base * least_rotation(up_in_base, up)).normalized();
  return turned;
}

}  // namespace fleetmap::agent
