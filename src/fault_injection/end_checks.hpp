#pragma once

#include <functional>
#include <optional>

#include "convergence.hpp"
#include "fleetmap/fault_injection/run_config.hpp"
#include "monitor.hpp"

namespace fleetmap::fault_injection {

/// A member that is compromised, as far as it shows in its items.
struct Compromised {
  AgentId robot;
  bool is_gross = false;  ///< its false nodes are such that it must be named
};

struct EndInput {
  const Robots& robots;
  const LocalFrame& site;
  Stamp now;
  std::optional<Compromised> compromised;
  bool anyone_forges = false;
  std::function<const Pose*(const NodeId&)> truth;  ///< T_enu_base of a node that a robot made, else null
};

/// Checks the maps of a fleet that has converged: equal, complete, true but for GPS errors, and with the
/// compromised robot named and no other.
void check_maps(const EndInput& input, Monitor& monitor, Outcome& outcome);
/// Checks that every robot holds what it announced and what others made.
void check_stores(const EndInput& input, Monitor& monitor);

}  // namespace fleetmap::fault_injection
