#include "rejection/candidate.hpp"

#include <algorithm>

#include "rejection/innovation.hpp"

namespace fleetmap::graph {
namespace {

bool is_certain(const AlignmentMode& mode) {
  return mode.covariance.diagonal().head<3>().maxCoeff() < kCertainM * kCertainM;
}

}  // namespace

std::vector<Candidate> candidates_of(std::span<const Alignment* const> alignments,
                                     std::span<const std::size_t> present, const ReducedGraph& graph,
                                     const FleetPlacementConfig& config) {
  Vector6d floor;
  floor << Eigen::Vector3d::Constant(config.alignment_floor_m),
      Eigen::Vector3d::Constant(config.alignment_floor_rad);
  std::vector<Candidate> candidates;
  for (const std::size_t k : present) {
    const Alignment& a = *alignments[k];
    const std::size_t i = graph.pose_of.at(a.i), j = graph.pose_of.at(a.j);
    const std::size_t frame_i = graph.poses[i].frame, frame_j = graph.poses[j].frame;
    const bool any_certain = std::ranges::any_of(a.modes, is_certain);
    for (std::size_t m = 0; m < a.modes.size(); ++m) {
      if (any_certain && !is_certain(a.modes[m])) continue;
      const Matrix6d C = a.modes[m].covariance + Matrix6d(floor.cwiseAbs2().asDiagonal());
      candidates.push_back({.alignment = k,
                            .mode = m,
                            .modes = a.modes.size(),
                            .factor = BetweenFactor(i, j, a.modes[m].T_i_j, C),
                            .frames = std::minmax(frame_i, frame_j),
                            .sign = std::pair(frame_i, i) < std::pair(frame_j, j) ? 1.0 : -1.0});
    }
  }
  return candidates;
}

}  // namespace fleetmap::graph
