#pragma once

#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/registration/register_clouds.hpp"

namespace fleetmap::loop_closure {

/// The alignment of a registration of node j (source) onto node i (target): one mode if it was accepted, the
/// modes that are likely enough if it is ambiguous. The covariance of nodes more than 30 m apart includes
/// that both see the same things from opposite sides.
graph::Alignment alignment_of(const NodeId& i, const NodeId& j, const AgentId& computed_by,
                              const registration::RegistrationResult& result);

}  // namespace fleetmap::loop_closure
