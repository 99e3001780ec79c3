#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace fleetmap::eval {

/// Number of `points` within `radius` (m) of each query (Eq. 4 of the paper with r_d the radius). A
/// query that is one of the points counts itself. 0 for a non-finite query; non-finite points never count.
std::vector<std::uint32_t> density_at(const std::vector<Eigen::Vector3f>& queries,
                                      const std::vector<Eigen::Vector3f>& points, float radius);

}  // namespace fleetmap::eval
