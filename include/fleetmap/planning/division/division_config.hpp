#pragma once

#include <cstdint>
#include <string>

#include "fleetmap/core/result.hpp"

namespace fleetmap::planning {

/// Method by which rows are divided among robots.
enum class DivisionMethod : std::uint8_t {
  kUniform,   ///< the paper's: equal counts of neighbouring rows, in the order of rows and robots
  kBalanced,  ///< the last robot is done as early as possible
  kEnergy,    ///< as kBalanced, but no robot drives its battery below the reserve
};
const char* to_string(DivisionMethod method);
Result<DivisionMethod> division_method(const std::string& name);

/// Method and search effort of the division.
struct DivisionConfig {
  DivisionMethod method = DivisionMethod::kBalanced;
  double battery_reserve = 0.2;  ///< share of `battery_wh` that is not planned with (kEnergy)
  int search_rounds = 300;       ///< of the local search; more rounds, better divisions, longer time
  std::uint64_t seed = 1;        ///< of the local search: the same on all robots
  Status validate() const;
};

}  // namespace fleetmap::planning
