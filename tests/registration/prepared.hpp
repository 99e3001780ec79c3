#pragma once

#include "fleetmap/registration/prepared_cloud.hpp"

namespace fleetmap::registration::testing {

inline PreparedCloud prepared(const cloud::PointCloud& cloud,
                              const Eigen::Vector3d& up = Eigen::Vector3d::UnitZ()) {
  return PreparedCloud(cloud, up, RegistrationConfig{});
}

}  // namespace fleetmap::registration::testing
