#pragma once

#include <span>
#include <vector>

#include "division/timed_route.hpp"
#include "fleetmap/planning/division/division.hpp"

namespace fleetmap::planning {

/// Best routes found for the workers.
std::vector<TimedRoute> search_division(const TravelCosts& costs, std::span<const std::size_t> rows,
                                        std::span<const Worker> workers, std::span<const Travel> to_end,
                                        const DivisionConfig& config);

/// Equal counts of neighbouring rows (the paper's).
std::vector<TimedRoute> uniform_division(const TravelCosts& costs, std::span<const std::size_t> rows,
                                         std::span<const Worker> workers, std::span<const Travel> to_end);

}  // namespace fleetmap::planning
