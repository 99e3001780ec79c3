#pragma once

#include <optional>

#include "fleetmap/agent/loop_closures.hpp"
#include "fleetmap/exchange/encounters.hpp"
#include "fleetmap/geometry/uncertain_pose.hpp"
#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"
#include "fleetmap/registration/register_clouds.hpp"

namespace fleetmap::agent {

/// The relative pose according to both G, with the uncertainty of both.
registration::Prior prior_of(const GlobalPose& target, const GlobalPose& source);

/// What is known of two nodes of different odometry frames: that of both G, if neither's horizontal sigma
/// exceeds EncounterConfig::max_sigma_m; else what their descriptors tell, if they are so much alike that
/// this may be an encounter (LookalikeConfig::min_similarity).
std::optional<registration::Prior> prior_of(const graph::Node& target, const graph::Node& source,
                                            const exchange::EncounterConfig& config);

/// The relative pose of two own nodes according to the odometry between them.
registration::Prior prior_of(const LoopClosure& closure);

/// That of two nodes whose frames are tied by alignments. Taken for no better than a good GPS, so that the
/// window holds the neighbouring rows and posts too: were the ties one off, the right place would be among
/// the rivals.
registration::Prior prior_of(const UncertainPose& T_target_source, const Eigen::Vector3d& up_in_target);

/// An alignment for the fleet, from a registration of node j (source) onto node i (target): one mode if it
/// was accepted, the modes that are good enough to be right if it is ambiguous. Of nodes more than 30 m apart
/// the covariance holds as well that both see the same things from different sides.
graph::Alignment alignment_of(const NodeId& i, const NodeId& j, const AgentId& computed_by,
                              const registration::RegistrationResult& result);

}  // namespace fleetmap::agent
