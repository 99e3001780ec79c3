#pragma once

#include "fleetmap/agent/agent_config.hpp"
#include "fleetmap/loop_closure/loop_closing_config.hpp"

namespace fleetmap::agent {

/// The configuration of an agent's loop closing, with time-outs for the size of its fleet.
inline loop_closure::LoopClosingConfig loop_closing_config(const AgentConfig& config) {
  loop_closure::LoopClosingConfig loops{
      config.id,       config.loop_closure,
      config.own_path, config.placement.method == graph::PlacementMethod::graph,
      config.spherize, config.registration};
  loops.candidates.peer_timeout = exchange::for_fleet(loops.candidates.peer_timeout, config.exchange);
  return loops;
}

}  // namespace fleetmap::agent
