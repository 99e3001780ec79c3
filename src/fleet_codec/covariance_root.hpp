#pragma once

#include <array>
#include <cstdint>

#include "fields.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::fleet_codec {

/// Lower Cholesky factor, row by row, in half floats: every element to 0.05 %, so that a long weak axis keeps
/// its direction to 5e-4 rad. Standard deviations [m, rad] are kept between 1e-4 and some 100. A matrix that
/// is no covariance (non-finite, a negative variance, a correlation beyond 1) is encoded as unknown: 100 m
/// and rad.
std::array<std::uint16_t, 21> encode_covariance(const Matrix6d& C);

/// Positive definite. Refuses non-finite numbers, and a diagonal that is not positive.
Matrix6d decode_covariance(const std::array<std::uint16_t, 21>& root, FieldCheck& check, const char* member);

}  // namespace fleetmap::fleet_codec
