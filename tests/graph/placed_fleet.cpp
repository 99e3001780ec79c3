#include "placed_fleet.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

namespace fleetmap::graph::testing {

std::string of(unsigned seed) { return std::string("seed ").append(std::to_string(seed)); }

Placement place(const SimulatedFleet& fleet, std::span<const NodeId> covariance_of) {
  return place_by_fleet_graph(fleet.nodes, fleet.alignments, fleet.site, {}, covariance_of);
}

double joint_error(const SimulatedFleet& fleet, const Placement& placement, const std::set<AgentId>& agents) {
  std::vector<Eigen::Vector3d> placed, true_place;
  for (const auto& [id, T] : fleet.truth) {
    if (!agents.empty() && !agents.contains(id.agent)) continue;
    placed.push_back(placement.T_enu_node.at(id).translation());
    true_place.push_back(T.translation());
  }
  const auto n = static_cast<Eigen::Index>(placed.size());
  const Eigen::Map<const Eigen::Matrix3Xd> A(placed.front().data(), 3, n), B(true_place.front().data(), 3, n);
  const Eigen::Matrix4d T = Eigen::umeyama(A, B, false);
  const Eigen::Matrix3Xd moved = (T.topLeftCorner<3, 3>() * A).colwise() + T.topRightCorner<3, 1>();
  return std::sqrt((moved - B).squaredNorm() / static_cast<double>(n));
}

std::map<AlignmentName, AlignmentStatus> statuses(const Placement& placement) {
  std::map<AlignmentName, AlignmentStatus> result;
  for (const AlignmentOutcome& one : placement.outcomes) result[{one.computed_by, one.seq}] = one.status;
  return result;
}

std::size_t count(const Placement& placement, AlignmentStatus status) {
  return static_cast<std::size_t>(std::ranges::count(placement.outcomes, status, &AlignmentOutcome::status));
}

std::set<AlignmentName> names_from(const SimulatedFleet& fleet, std::size_t first) {
  std::set<AlignmentName> names;
  for (std::size_t k = first; k < fleet.alignments.size(); ++k)
    names.emplace(fleet.alignments[k].computed_by, fleet.alignments[k].seq);
  return names;
}

void expect_none_used(const Placement& placement, const std::set<AlignmentName>& names,
                      const std::string& what) {
  for (const auto& [name, status] : statuses(placement)) {
    if (names.contains(name)) {
      EXPECT_NE(status, AlignmentStatus::used) << what << ": " << name.first.str() << '/' << name.second;
    }
  }
}

}  // namespace fleetmap::graph::testing
