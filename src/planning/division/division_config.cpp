#include "fleetmap/planning/division/division_config.hpp"

#include <string>

namespace fleetmap::planning {

const char* to_string(DivisionMethod method) {
  switch (method) {
    case DivisionMethod::kUniform:
      return "uniform";
    case DivisionMethod::kBalanced:
      return "balanced";
    case DivisionMethod::kEnergy:
      return "energy";
  }
  return "unknown";
}

Result<DivisionMethod> division_method(const std::string& name) {
  for (const DivisionMethod method :
       {DivisionMethod::kUniform, DivisionMethod::kBalanced, DivisionMethod::kEnergy}) {
    if (name == to_string(method)) return method;
  }
  return failure("expected uniform, balanced or energy, found '" + name + "'");
}

Status DivisionConfig::validate() const {
  if (!(battery_reserve >= 0.0 && battery_reserve < 1.0)) {
    return failure("battery_reserve: must be within [0, 1)");
  }
  if (search_rounds < 0 || search_rounds > 1'000'000) {
    return failure("search_rounds: must be within [0, 1000000]");
  }
  return {};
}

}  // namespace fleetmap::planning
