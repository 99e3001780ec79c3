#include "fleetmap/planning/driving/path_follower_config.hpp"

#include <cmath>
#include <string>
#include <utility>

namespace fleetmap::planning {

Status PathFollowerConfig::validate() const {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0.0; };
  for (const auto& [name, value] : {std::pair<const char*, double>{"max_speed", max_speed},
                                    {"max_reverse", max_reverse},
                                    {"max_yaw_rate", max_yaw_rate},
                                    {"acceleration", acceleration},
                                    {"braking", braking},
                                    {"robot_radius", robot_radius},
                                    {"wanted_clearance", wanted_clearance},
                                    {"horizon", horizon},
                                    {"corner_tolerance", corner_tolerance},
                                    {"goal_tolerance", goal_tolerance},
                                    {"give_up_radius", give_up_radius},
                                    {"give_up_after", give_up_after},
                                    {"turn_in_place", turn_in_place},
                                    {"stuck_after", stuck_after},
                                    {"stuck_distance", stuck_distance}}) {
    if (!positive(value)) return failure(std::string(name) + ": must be finite and > 0");
  }
  for (const auto& [name, value] : {std::pair<const char*, double>{"reaction_time", reaction_time},
                                    {"margin", margin},
                                    {"lateral_error", lateral_error},
                                    {"lateral_weight", lateral_weight}}) {
    if (!(std::isfinite(value) && value >= 0.0))
      return failure(std::string(name) + ": must be finite and >= 0");
  }
  if (horizon < 2.0 || horizon > 15.0) return failure("horizon: must be within [2, 15] m");
  if (wanted_clearance <= robot_radius + margin || wanted_clearance > 5.0) {
    return failure("wanted_clearance: must be above robot_radius + margin and at most 5 m");
  }
  return {};
}

}  // namespace fleetmap::planning
