#pragma once

#include <span>

#include "fleetmap/core/ids.hpp"
#include "loaded_run.hpp"

namespace fleetmap::apps {

/// Adds to the view of a run what its link traces and reports tell of the radios, without the robots
/// `without`, and notes lines that cannot be read.
void add_radio(LoadedRun& run, std::span<const AgentId> without);

}  // namespace fleetmap::apps
