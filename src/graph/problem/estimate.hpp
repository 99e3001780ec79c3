#pragma once

#include <Eigen/Core>
#include <vector>

#include "problem/reduced_graph.hpp"

namespace fleetmap::graph {

/// Values of the variables of a ReducedGraph, by index of the pose variable.
struct Estimate {
  std::vector<Pose> T_enu;
  std::vector<Eigen::Vector3d> drift;  ///< of GPS, in units of the window's sigma; zero without a window
};

/// Linearised residual of a relative pose between two pose variables: e + H_a xi_a + xi_b.
struct RelativeResidual {
  Vector6d e;  ///< log(T_a_b^-1 T_enu_a^-1 T_enu_b)
  Matrix6d H_a;
};
RelativeResidual relative_residual(const Estimate& estimate, std::size_t a, std::size_t b, const Pose& T_a_b);

/// Weight of an alignment with residual `e` by Huber's kernel ("Robust Estimation of a Location Parameter",
/// 1964).
double huber_weight(const BetweenFactor& factor, const Vector6d& e);

}  // namespace fleetmap::graph
