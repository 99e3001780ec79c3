#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fleetmap/experiment/case.hpp"

namespace fleetmap::experiment {

/// Cases with equal inputs: one run serves them all, by its name that of the first.
struct CaseGroup {
  std::vector<std::size_t> cases;  ///< indices, ascending
  std::string hash;                ///< of their inputs
};

/// By their first cases, in the order of `cases`. Fails when the inputs of a case cannot be read.
Result<std::vector<CaseGroup>> grouped(const std::vector<Case>& cases);

}  // namespace fleetmap::experiment
