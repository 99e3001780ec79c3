// Spherization, FPFH + RANSAC and ICP against PCL's on the same made clouds. Counter: error in m of the pose
// found.
#include <benchmark/benchmark.h>
#include <pcl/features/fpfh.h>
#include <pcl/features/normal_3d.h>
#include <pcl/point_types.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/sample_consensus_prerejective.h>

#include "fleetmap/cloud/voxel_grid.hpp"
#include "fleetmap/registration/register_clouds.hpp"
#include "fleetmap/registration/spherize.hpp"
#include "registration/made_world.hpp"

namespace {

using namespace fleetmap;
using namespace fleetmap::registration;
using fleetmap::registration::testing::MadeWorld;
using PclCloud = pcl::PointCloud<pcl::PointNormal>;
using PclFeatures = pcl::PointCloud<pcl::FPFHSignature33>;

struct Clouds {
  cloud::PointCloud target, source;
  Pose T_target_source;
};

const Clouds& clouds() {
  static const Clouds made = [] {
    const MadeWorld world(11);
    const Pose T_world_target = make_pose(rotation_from_rpy(0, 0, 0.4), Eigen::Vector3d(0, 0, 1.2));
    const Pose T_target_source = make_pose(rotation_from_rpy(0.03, -0.02, 0.9), Eigen::Vector3d(6, 4, 0.1));
    return Clouds{world.scan(T_world_target, 20'000, 0.03, 1),
                  world.scan(T_world_target * T_target_source, 20'000, 0.03, 2), T_target_source};
  }();
  return made;
}

double error_of(const Pose& T) {
  return 1000.0 * testing::error_between(clouds().T_target_source, T).translation_m;
}

void spherization(benchmark::State& state) {
  static const cloud::PointCloud map = MadeWorld(7).scan(Pose::Identity(), 250'000, 0.02, 7, 60.0);
  for (auto _ : state) {
    const auto result = spherize(map, Eigen::Vector3f::UnitZ(), {});
    state.counters["bytes"] = static_cast<double>(result->bytes.size());
    state.counters["points"] = static_cast<double>(result->encoded);
  }
}

void whole_registration(benchmark::State& state) {
  for (auto _ : state) {
    state.counters["error_mm"] =
        error_of(register_clouds(clouds().target, clouds().source, {}).T_target_source);
  }
}

PclCloud::Ptr pcl_cloud(const cloud::PointCloud& cloud, float voxel_m, const RegistrationConfig& config) {
  auto out = std::make_shared<PclCloud>();
  const auto thin = voxel_downsample(cloud, voxel_m);
  const auto normals = estimate_normals(thin, cloud::KdTree(thin), config.feature_normals);
  for (std::size_t i = 0; i < thin.size(); ++i) {
    if (normals.normals[i].isZero()) continue;
    pcl::PointNormal point;
    point.getVector3fMap() = thin.points[i];
    point.getNormalVector3fMap() = normals.normals[i];
    out->push_back(point);
  }
  return out;
}

void features_and_ransac(benchmark::State& state) {
  const RegistrationConfig config;
  for (auto _ : state) {
    const auto features = [&](const cloud::PointCloud& whole) {
      auto thin = voxel_downsample(whole, config.feature_voxel_m);
      const auto normals = estimate_normals(thin, cloud::KdTree(thin), config.feature_normals);
      auto found = compute_fpfh(thin, normals, config.feature_radius_m);
      return std::pair(std::move(thin), std::move(found));
    };
    const auto [a, fa] = features(clouds().target);
    const auto [b, fb] = features(clouds().source);
    const auto found = ransac(a, b, match_features(fa, fb, config.matching), config.ransac, std::nullopt);
    state.counters["error_mm"] = found.empty() ? 99e3 : error_of(found.front().T_target_source);
  }
}

PclFeatures::Ptr pcl_fpfh(const PclCloud::Ptr& cloud, const RegistrationConfig& config) {
  pcl::FPFHEstimation<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33> fpfh;
  fpfh.setInputCloud(cloud);
  fpfh.setInputNormals(cloud);
  fpfh.setRadiusSearch(static_cast<double>(config.feature_radius_m));
  auto features = std::make_shared<PclFeatures>();
  fpfh.compute(*features);
  return features;
}

void pcl_features_and_ransac(benchmark::State& state) {
  const RegistrationConfig config;
  for (auto _ : state) {
    const auto a = pcl_cloud(clouds().target, config.feature_voxel_m, config);
    const auto b = pcl_cloud(clouds().source, config.feature_voxel_m, config);
    pcl::SampleConsensusPrerejective<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33> align;
    align.setInputSource(b);
    align.setSourceFeatures(pcl_fpfh(b, config));
    align.setInputTarget(a);
    align.setTargetFeatures(pcl_fpfh(a, config));
    align.setMaximumIterations(4000);
    align.setNumberOfSamples(3);
    align.setCorrespondenceRandomness(2);
    align.setSimilarityThreshold(0.9f);
    align.setMaxCorrespondenceDistance(1.0);
    align.setInlierFraction(0.2f);
    PclCloud moved;
    align.align(moved);
    state.counters["error_mm"] = error_of(Pose(align.getFinalTransformation().cast<double>()));
  }
}

Pose rough_start() {
  return clouds().T_target_source *
         make_pose(rotation_from_rpy(0.01, 0.0, 0.05), Eigen::Vector3d(0.5, -0.4, 0.1));
}

void point_to_plane_icp(benchmark::State& state) {
  const RegistrationConfig config;
  const auto a = voxel_downsample(clouds().target, config.voxel_m);
  const auto b = voxel_downsample(clouds().source, config.voxel_m);
  for (auto _ : state) {
    const cloud::KdTree tree(a);
    const auto normals = estimate_normals(a, tree, config.normals);
    state.counters["error_mm"] =
        error_of(icp({a, tree, normals}, {b, {}}, rough_start(), config.icp).T_target_source);
  }
}

void pcl_point_to_plane_icp(benchmark::State& state) {
  const RegistrationConfig config;
  for (auto _ : state) {
    const auto a = pcl_cloud(clouds().target, config.voxel_m, config);
    const auto b = pcl_cloud(clouds().source, config.voxel_m, config);
    pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal> align;
    align.setInputSource(b);
    align.setInputTarget(a);
    align.setMaxCorrespondenceDistance(1.0);
    align.setMaximumIterations(24);
    PclCloud moved;
    align.align(moved, rough_start().matrix().cast<float>());
    state.counters["error_mm"] = error_of(Pose(align.getFinalTransformation().cast<double>()));
  }
}

BENCHMARK(spherization)->Unit(benchmark::kMillisecond);
BENCHMARK(whole_registration)->Unit(benchmark::kMillisecond);
BENCHMARK(features_and_ransac)->Unit(benchmark::kMillisecond);
BENCHMARK(pcl_features_and_ransac)->Unit(benchmark::kMillisecond);
BENCHMARK(point_to_plane_icp)->Unit(benchmark::kMillisecond);
BENCHMARK(pcl_point_to_plane_icp)->Unit(benchmark::kMillisecond);

}  // namespace
