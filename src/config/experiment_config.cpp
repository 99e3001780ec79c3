#include "fleetmap/config/experiment_config.hpp"

#include <algorithm>

namespace fleetmap::config {

const char* to_string(Shape shape) {
  switch (shape) {
    case Shape::kFalls:
      return "falls";
    case Shape::kRises:
      return "rises";
    case Shape::kFallsLessThanLinearly:
      return "falls_less_than_linearly";
    case Shape::kDoesNotRise:
      return "does_not_rise";
    case Shape::kDoesNotFall:
      return "does_not_fall";
  }
  return "";
}

const MetricSpec* ExperimentConfig::metric(const std::string& name) const {
  const auto found = std::ranges::find(metrics, name, &MetricSpec::name);
  return found == metrics.end() ? nullptr : &*found;
}

}  // namespace fleetmap::config
