#pragma once

#include <Eigen/Core>
#include <vector>

namespace fleetmap::testing {

using Points = std::vector<Eigen::Vector3f>;

}  // namespace fleetmap::testing
