#include "fleetmap/place/node_generator.hpp"

#include <cmath>

namespace fleetmap::place {

bool NodeGenerator::offer(const Pose& T_odom_base) {
  if (!all_finite(T_odom_base)) {
    ++refused_;
    return false;
  }
  const Eigen::Vector3d p = T_odom_base.translation();
  if (last_ && (p - *last_).norm() <= config_.spacing) return false;
  last_ = p;
  return true;
}

}  // namespace fleetmap::place
