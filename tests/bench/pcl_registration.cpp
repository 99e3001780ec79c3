#include <pcl/features/fpfh.h>
#include <pcl/point_types.h>
#include <pcl/registration/gicp.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/sample_consensus_prerejective.h>

#include "bench/library_registration.hpp"
#include "fleetmap/cloud/normals.hpp"
#include "fleetmap/cloud/voxel_grid.hpp"

namespace fleetmap::bench {
namespace {

using Cloud = pcl::PointCloud<pcl::PointNormal>;
using Features = pcl::PointCloud<pcl::FPFHSignature33>;

Cloud::Ptr with_normals(const cloud::PointCloud& cloud, float voxel) {
  auto out = std::make_shared<Cloud>();
  const auto thin = voxel_downsample(cloud, voxel);
  const auto normals =
      estimate_normals(thin, cloud::KdTree(thin), {16, kNormalRadius, 5, Eigen::Vector3f::Zero()});
  for (std::size_t i = 0; i < thin.size(); ++i) {
    if (normals.normals[i].isZero()) continue;
    pcl::PointNormal point;
    point.getVector3fMap() = thin.points[i];
    point.getNormalVector3fMap() = normals.normals[i];
    out->push_back(point);
  }
  return out;
}

Features::Ptr fpfh(const Cloud::Ptr& cloud) {
  pcl::FPFHEstimation<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33> estimation;
  estimation.setInputCloud(cloud);
  estimation.setInputNormals(cloud);
  estimation.setRadiusSearch(kFeatureRadius);
  auto features = std::make_shared<Features>();
  estimation.compute(*features);
  return features;
}

template <class Method>
Pose refined(Method& method, const cloud::PointCloud& target, const cloud::PointCloud& source,
             const Pose& start) {
  method.setInputSource(with_normals(source, kFineVoxel));
  method.setInputTarget(with_normals(target, kFineVoxel));
  method.setMaxCorrespondenceDistance(kReach);
  method.setMaximumIterations(kIterations);
  Cloud moved;
  method.align(moved, start.matrix().cast<float>());
  return Pose(method.getFinalTransformation().template cast<double>());
}

}  // namespace

Pose pcl_icp(const cloud::PointCloud& target, const cloud::PointCloud& source, const Pose& start) {
  pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal> method;
  return refined(method, target, source, start);
}

Pose pcl_gicp(const cloud::PointCloud& target, const cloud::PointCloud& source, const Pose& start) {
  pcl::GeneralizedIterativeClosestPoint<pcl::PointNormal, pcl::PointNormal> method;
  return refined(method, target, source, start);
}

Pose pcl_global(const cloud::PointCloud& target, const cloud::PointCloud& source) {
  const auto a = with_normals(target, kFeatureVoxel), b = with_normals(source, kFeatureVoxel);
  pcl::SampleConsensusPrerejective<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33> global;
  global.setInputSource(b);
  global.setSourceFeatures(fpfh(b));
  global.setInputTarget(a);
  global.setTargetFeatures(fpfh(a));
  global.setMaximumIterations(4000);
  global.setNumberOfSamples(3);
  global.setCorrespondenceRandomness(2);
  global.setSimilarityThreshold(0.9f);
  global.setMaxCorrespondenceDistance(kReach);
  global.setInlierFraction(0.2f);
  Cloud moved;
  global.align(moved);
  return pcl_icp(target, source, Pose(global.getFinalTransformation().cast<double>()));
}

}  // namespace fleetmap::bench
