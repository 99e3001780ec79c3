#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/bus/fleet_settings.hpp"
#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/time.hpp"

namespace fleetmap::bus {

/// Robots heard on a radio since the bus joined it. Places are "10.0.0.2:7660".
struct RadioSurvey {
  struct Robot {
    AgentId agent;
    std::string place;
    bool here = false;                      ///< on this machine
    std::uint32_t domain = 0;               ///< to which that port belongs
    Duration after{};                       ///< joining, when it was first heard
    std::optional<FleetSettings> settings;  ///< its last; empty: an operator's program
    bool multicast = false;                 ///< it listens to what goes out once for all
  };
  std::string problem;               ///< why the radio is silent; empty: it is not
  std::vector<Robot> robots;         ///< in the order in which they were first heard
  std::size_t places = 0;            ///< addresses at which robots are sought
  std::vector<std::string> silent;   ///< addresses of other machines in `peers` without a robot so far
  std::vector<std::string> refused;  ///< robots not exchanged with, and why; also those that left
  std::vector<std::string> different_settings;  ///< of other robots that must equal this one's
};

}  // namespace fleetmap::bus
