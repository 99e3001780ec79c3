#include "alignment_certainty.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace fleetmap::apps {
namespace {

/// Along the least certain direction.
double largest_sigma(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues().maxCoeff()));
}

}  // namespace

AlignmentCertainty certainty_of(std::span<const graph::Alignment> alignments) {
  if (alignments.empty()) return {};
  std::vector<double> positions, rotations;
  for (const graph::Alignment& alignment : alignments) {
    const Matrix6d& covariance = alignment.best().covariance;
    positions.push_back(largest_sigma(covariance.topLeftCorner<3, 3>()));
    rotations.push_back(largest_sigma(covariance.bottomRightCorner<3, 3>()));
  }
  std::ranges::sort(positions);
  std::ranges::sort(rotations);
  const std::size_t middle = alignments.size() / 2;
  return {positions[middle], positions.back(), rotations[middle], rotations.back()};
}

}  // namespace fleetmap::apps
