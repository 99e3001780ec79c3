#pragma once

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/geometry/se3.hpp"

/// Registration as libraries have it, to compare with: settings as their tutorials give them, voxels of 0.6 m
/// for the features and of 0.3 m for the fine step, as sparse as a cloud of 25 kB is. All return
/// T_target_source; where the library fails that is what it returned.
namespace fleetmap::bench {

inline constexpr float kFeatureVoxel = 0.6f;  ///< m
inline constexpr float kFineVoxel = 0.3f;     ///< m
inline constexpr int kNormalNeighbours = 16;
inline constexpr float kFeatureRadius = 3.0f;  ///< m
inline constexpr double kReach = 1.0;          ///< m, farthest correspondence
inline constexpr int kIterations = 24;

/// FPFH, SampleConsensusPrerejective, ICP with normals.
Pose pcl_global(const cloud::PointCloud& target, const cloud::PointCloud& source);
Pose pcl_icp(const cloud::PointCloud& target, const cloud::PointCloud& source, const Pose& start);
Pose pcl_gicp(const cloud::PointCloud& target, const cloud::PointCloud& source, const Pose& start);

/// FPFH, RANSAC on matched features, point-to-plane ICP.
Pose open3d_global(const cloud::PointCloud& target, const cloud::PointCloud& source);
Pose open3d_icp(const cloud::PointCloud& target, const cloud::PointCloud& source, const Pose& start);
Pose open3d_gicp(const cloud::PointCloud& target, const cloud::PointCloud& source, const Pose& start);

}  // namespace fleetmap::bench
