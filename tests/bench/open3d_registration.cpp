#include <open3d/geometry/KDTreeSearchParam.h>
#include <open3d/geometry/PointCloud.h>
#include <open3d/pipelines/registration/Feature.h>
#include <open3d/pipelines/registration/GeneralizedICP.h>
#include <open3d/pipelines/registration/Registration.h>

#include "bench/library_registration.hpp"

namespace fleetmap::bench {
namespace {

namespace o3d = open3d::pipelines::registration;

open3d::geometry::PointCloud with_normals(const cloud::PointCloud& cloud, double voxel) {
  open3d::geometry::PointCloud all;
  all.points_.reserve(cloud.size());
  for (const Eigen::Vector3f& p : cloud.points) all.points_.push_back(p.cast<double>());
  open3d::geometry::PointCloud thin = *all.VoxelDownSample(voxel);
  thin.EstimateNormals(open3d::geometry::KDTreeSearchParamKNN(kNormalNeighbours));
  return thin;
}

Pose pose_of(const o3d::RegistrationResult& result) { return Pose(Eigen::Matrix4d(result.transformation_)); }

const o3d::ICPConvergenceCriteria kCriteria(1e-6, 1e-6, kIterations);

}  // namespace

Pose open3d_icp(const cloud::PointCloud& target, const cloud::PointCloud& source, const Pose& start) {
  return pose_of(o3d::RegistrationICP(with_normals(source, kFineVoxel), with_normals(target, kFineVoxel),
                                      kReach, start.matrix(), o3d::TransformationEstimationPointToPlane(),
                                      kCriteria));
}

Pose open3d_gicp(const cloud::PointCloud& target, const cloud::PointCloud& source, const Pose& start) {
  return pose_of(o3d::RegistrationGeneralizedICP(
      with_normals(source, kFineVoxel), with_normals(target, kFineVoxel), kReach, start.matrix(),
      o3d::TransformationEstimationForGeneralizedICP(), kCriteria));
}

Pose open3d_global(const cloud::PointCloud& target, const cloud::PointCloud& source) {
  const auto a = with_normals(target, kFeatureVoxel), b = with_normals(source, kFeatureVoxel);
  const open3d::geometry::KDTreeSearchParamHybrid search(kFeatureRadius, 100);
  const o3d::CorrespondenceCheckerBasedOnEdgeLength edges(0.9);
  const o3d::CorrespondenceCheckerBasedOnDistance distance(kReach);
  const auto result = o3d::RegistrationRANSACBasedOnFeatureMatching(
      b, a, *o3d::ComputeFPFHFeature(b, search), *o3d::ComputeFPFHFeature(a, search), true, kReach,
      o3d::TransformationEstimationPointToPoint(false), 3, {edges, distance},
      o3d::RANSACConvergenceCriteria(100000, 0.999));
  return open3d_icp(target, source, pose_of(result));
}

}  // namespace fleetmap::bench
