#include "pair_features.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

namespace fleetmap::registration {
namespace {

Eigen::Vector4f direction(Eigen::Vector4f v) {
  v[3] = 0.0f;
  return v;
}

}  // namespace

PairFeatures pair_features(const Eigen::Vector4f& p1, const Eigen::Vector4f& n1, const Eigen::Vector4f& p2,
                           const Eigen::Vector4f& n2) {
  Eigen::Vector4f line = direction(p2 - p1), u = direction(n1), n_t = direction(n2);
  const float distance = line.norm();
  if (distance == 0.0f) return {};
  float phi = u.dot(line) / distance;
  const float other = n_t.dot(line) / distance;
  // acos() of the cosines, since these are equal more often once rounded, and a normal of length above 1
  // compares as neither.
  if (std::acos(std::fabs(phi)) > std::acos(std::fabs(other))) {
    std::swap(u, n_t);
    line = -line;
    phi = -other;
  }
  Eigen::Vector4f v = line.cross3(u);
  const float v_norm = v.norm();
  if (v_norm == 0.0f) return {};
  v /= v_norm;
  const Eigen::Vector4f w = u.cross3(v);
  return {std::atan2(w.dot(n_t), u.dot(n_t)), v.dot(n_t), phi, distance};
}

}  // namespace fleetmap::registration
