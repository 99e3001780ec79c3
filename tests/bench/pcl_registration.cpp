#include <pcl/common/io.h>
#include <pcl/features/fpfh.h>
#include <pcl/features/normal_3d.h>
#include <pcl/filters/filter.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/point_types.h>
#include <pcl/registration/gicp.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/sample_consensus_prerejective.h>

#include "bench/library_registration.hpp"

namespace fleetmap::bench {
namespace {

using Cloud = pcl::PointCloud<pcl::PointNormal>;
using Features = pcl::PointCloud<pcl::FPFHSignature33>;

pcl::PointCloud<pcl::PointXYZ>::Ptr thinned(const cloud::PointCloud& cloud, float voxel) {
  auto all = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>(), thin = all->makeShared();
  for (const Eigen::Vector3f& p : cloud.points) all->push_back({p.x(), p.y(), p.z()});
  pcl::VoxelGrid<pcl::PointXYZ> grid;
  grid.setInputCloud(all);
  grid.setLeafSize(voxel, voxel, voxel);
  grid.filter(*thin);
  return thin;
}

Cloud::Ptr with_normals(const cloud::PointCloud& cloud, float voxel) {
  const auto thin = thinned(cloud, voxel);
  auto out = std::make_shared<Cloud>();
  pcl::copyPointCloud(*thin, *out);
  pcl::NormalEstimation<pcl::PointXYZ, pcl::PointNormal> estimation;
  estimation.setInputCloud(thin);
  estimation.setKSearch(kNormalNeighbours);
  estimation.compute(*out);
  std::vector<int> kept;
  pcl::removeNaNNormalsFromPointCloud(*out, *out, kept);
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

template <class Method, class Points>
Pose refined(Method& method, const Points& target, const Points& source, const Pose& start) {
  method.setInputSource(source);
  method.setInputTarget(target);
  method.setMaxCorrespondenceDistance(kReach);
  method.setMaximumIterations(kIterations);
  typename Points::element_type moved;
  method.align(moved, start.matrix().cast<float>());
  return Pose(method.getFinalTransformation().template cast<double>());
}

}  // namespace

Pose pcl_icp(const cloud::PointCloud& target, const cloud::PointCloud& source, const Pose& start) {
  pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal> method;
  return refined(method, with_normals(target, kFineVoxel), with_normals(source, kFineVoxel), start);
}

Pose pcl_gicp(const cloud::PointCloud& target, const cloud::PointCloud& source, const Pose& start) {
  pcl::GeneralizedIterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> method;
  return refined(method, thinned(target, kFineVoxel), thinned(source, kFineVoxel), start);
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
