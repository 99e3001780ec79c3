#pragma once

#include <filesystem>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::run_evaluation {

/// A truth: a cloud (.ply, .pcd) as it is, points on the surface of a mesh (.obj, or .ply with faces) or of a
/// world (.yaml).
Result<cloud::PointCloud> truth_cloud(const std::filesystem::path& file, double points_per_m2);

}  // namespace fleetmap::run_evaluation
