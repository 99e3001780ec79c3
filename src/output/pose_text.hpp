#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::output {

/// "x y z qx qy qz qw" with so many digits behind the point: `digits_m` of the translation (m), `digits_q` of
/// the quaternion. As in TUM files and registrations.csv.
std::string pose_text(const Pose& T, int digits_m, int digits_q);

/// A finite decimal number that is the whole text.
std::optional<double> finite_number(std::string_view text);

}  // namespace fleetmap::output
