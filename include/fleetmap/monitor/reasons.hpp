#pragma once

#include <cstddef>
#include <map>
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
/// The same of texts that were counted.
std::vector<Reason> reasons_of(const std::map<std::string, std::size_t>& counts);

}  // namespace fleetmap::monitor
