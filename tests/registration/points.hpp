#pragma once

#include <Eigen/Core>
#include <vector>

namespace fleetmap::registration::testing {

using Points = std::vector<Eigen::Vector3f>;

}  // namespace fleetmap::registration::testing
