#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "fleet_placement.hpp"
#include "simulated_fleet.hpp"

namespace fleetmap::graph::testing {

using AlignmentName = std::pair<AgentId, std::uint32_t>;  ///< computed by, number

inline const Eigen::Vector3d kOneRow(kPitch, 0.0, 0.0);
inline const AgentId kR1 = SimulatedFleet::agent(0), kR2 = SimulatedFleet::agent(1),
                     kR3 = SimulatedFleet::agent(2);

std::string of(unsigned seed);

Placement place(const SimulatedFleet& fleet, std::span<const NodeId> covariance_of = {});

/// RMS error of the positions of all nodes of `agents` (all, if empty), as one rigid body: what of the map is
/// bent.
double joint_error(const SimulatedFleet& fleet, const Placement& placement,
                   const std::set<AgentId>& agents = {});

std::map<AlignmentName, AlignmentStatus> statuses(const Placement& placement);
std::size_t count(const Placement& placement, AlignmentStatus status);

/// Names of the alignments from the k-th on.
std::set<AlignmentName> names_from(const SimulatedFleet& fleet, std::size_t first);

void expect_none_used(const Placement& placement, const std::set<AlignmentName>& names,
                      const std::string& what);

}  // namespace fleetmap::graph::testing
