#pragma once

#include "driving/local_field.hpp"
#include "driving/rollout_config.hpp"

namespace fleetmap::planning {

/// An arc from where the robot stands.
struct Arc {
  double curvature = 0.0;                   ///< 1/m, positive to the left
  double score = LocalField::kUnreachable;  ///< m of easy driving along it and from its end; less is better
  double free = 0.0;                        ///< m, until the robot would touch something
  double clearance = 0.0;                   ///< m, least over the first metre
};

/// m between the points of an arc that are checked.
inline constexpr double kRolloutStep = 0.15;

/// Rolls one arc out over the field (Brock and Khatib's global dynamic window). The score is
/// LocalField::kUnreachable if it is too short or its end leads nowhere.
Arc roll_out(const LocalField& field, double curvature, const RolloutConfig& config);

/// The arc with the least score of a fixed set of curvatures.
Arc best_arc(const LocalField& field, const RolloutConfig& config);

/// rad, from ahead: direction in which the field's cost falls, over about a metre. 0 where it falls nowhere.
double descent_heading(const LocalField& field);

}  // namespace fleetmap::planning
