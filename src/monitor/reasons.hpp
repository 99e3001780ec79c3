#pragma once

#include <string>
#include <vector>

#include "fleetmap/monitor/attempt.hpp"

namespace fleetmap::monitor {

/// Reasons that differ in their numbers alone are one: "inlier RMSE is 0.06 to 0.08 m".
struct Reason {
  std::string text;
  std::size_t count = 0;
};

/// Why attempts were not accepted, the commonest first.
std::vector<Reason> reasons_of(const std::vector<const Attempt*>& attempts);

}  // namespace fleetmap::monitor
