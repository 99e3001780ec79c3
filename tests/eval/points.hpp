#pragma once

#include <Eigen/Core>
#include <vector>

namespace fleetmap::eval {

using Points = std::vector<Eigen::Vector3f>;

}  // namespace fleetmap::eval
