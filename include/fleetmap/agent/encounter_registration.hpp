#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "fleetmap/agent/loop_closures.hpp"
#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"
#include "fleetmap/registration/register_clouds.hpp"
#include "fleetmap/registration/spherize.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::agent {

/// An own node and the encoded submaps around it: what its spherized cloud is made of.
struct Surroundings {
  graph::Node node;
  std::vector<std::pair<Pose, Bytes>> submaps;  ///< T_node_submap and the encoded points
};

/// Nodes with a submap, of the same odometry frame and within `radius` (m) of `node`: T_node_submap of each.
std::vector<std::pair<NodeId, Pose>> submaps_around(const store::Store& store, const graph::Node& node,
                                                    double radius);

/// Reads these submaps from the store.
Surroundings gather(store::Store& store, const graph::Node& node, double radius);

/// Alg. 3, first half: M^s around the node, in its base_link. Takes no store, so it may run off its thread.
Result<registration::SpherizedCloud> spherize(const Surroundings& surroundings,
                                              const registration::SpherizeConfig& config);

/// The relative pose according to both G, with the uncertainty of both.
registration::Prior prior_of(const GlobalPose& target, const GlobalPose& source);

/// What is known of two nodes of different odometry frames: that of both G, if neither's horizontal sigma
/// exceeds `max_sigma` (m); else what their descriptors tell, if they have anything in common.
std::optional<registration::Prior> prior_of(const graph::Node& target, const graph::Node& source,
                                            double max_sigma);

/// The relative pose of two own nodes according to the odometry between them.
registration::Prior prior_of(const LoopClosure& closure);

/// An alignment for the fleet, from a registration of node j (source) onto node i (target): one mode if it
/// was accepted, the modes that are good enough to be right if it is ambiguous.
graph::Alignment alignment_of(const NodeId& i, const NodeId& j, const AgentId& computed_by,
                              const registration::RegistrationResult& result);

}  // namespace fleetmap::agent
