#pragma once

#include <Eigen/Core>

namespace fleetmap::registration {

/// Relation of two oriented points, in the Darboux frame of the one whose normal is nearer to the
/// line between them (Rusu, Blodow and Beetz, ICRA 2009, Eq. 1).
struct PairFeatures {
  float theta = 0.0f;     ///< rad, atan2(w . n_t, u . n_t)
  float alpha = 0.0f;     ///< v . n_t
  float phi = 0.0f;       ///< u . (p_t - p_s) / distance
  float distance = 0.0f;  ///< m
};

/// Last elements are ignored. All zero where the points coincide or a normal lies along their line. The bits
/// are those of PCL's computePairFeatures: every sum is taken in its order.
PairFeatures pair_features(const Eigen::Vector4f& p1, const Eigen::Vector4f& n1, const Eigen::Vector4f& p2,
                           const Eigen::Vector4f& n2);

}  // namespace fleetmap::registration
