#pragma once

#include <Eigen/Core>

namespace fleetmap::eval {

inline constexpr float kFarthest = 1e6f;  ///< m: nothing of a site lies farther from its origin

inline bool is_usable(const Eigen::Vector3f& p) {
  return p.allFinite() && p.cwiseAbs().maxCoeff() < kFarthest;
}

}  // namespace fleetmap::eval
