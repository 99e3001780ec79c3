#pragma once

#include <filesystem>
#include <ostream>

#include "twin/virtual_fleet.hpp"

namespace fleetmap::apps {

/// Prints the outcome of a fleet's run whose results are in `folder`.
void print_summary(std::ostream& out, const FleetOutcome& outcome, const std::filesystem::path& folder);

}  // namespace fleetmap::apps
