// Registration of encounters on generated sites against PCL's FPFH + SampleConsensusPrerejective + ICP with
// normals on the same clouds. Counters: share of encounters within 0.5 m and 2 deg of the truth, and the
// median error of those.
#include <benchmark/benchmark.h>
#include <pcl/features/fpfh.h>
#include <pcl/point_types.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/sample_consensus_prerejective.h>

#include <algorithm>

#include "fleetmap/cloud/normals.hpp"
#include "fleetmap/cloud/voxel_grid.hpp"
#include "fleetmap/registration/register_clouds.hpp"
#include "fleetmap/registration/spherize.hpp"
#include "registration/encounter_worlds.hpp"
#include "registration/made_world.hpp"

namespace {

using namespace fleetmap;
using namespace fleetmap::registration;
using namespace fleetmap::registration::testing;
using PclCloud = pcl::PointCloud<pcl::PointNormal>;
using PclFeatures = pcl::PointCloud<pcl::FPFHSignature33>;

struct Encounter {
  cloud::PointCloud target, source;
  Pose truth;
  Prior prior;
};

std::vector<Encounter> encounters_on(const Site& site, unsigned seed) {
  Gathering how;
  how.scan_spacing_m = 2.0;
  std::vector<MappedNode> nodes;
  const std::size_t lane = site.lanes.size() / 2;
  for (unsigned k = 0; k < 4; ++k) {
    const sim::Aisle& aisle = site.lanes[lane + k % 3];
    nodes.push_back(map_node(site, aisle, 0.4 * (aisle.to - aisle.from).norm() + 4.0 * k, 0.2, k % 2 == 1,
                             how, seed + k));
    const Eigen::Vector3d up = nodes.back().T_enu_node.linear().transpose() * Eigen::Vector3d::UnitZ();
    nodes.back().map = spherize(nodes.back().map, up.cast<float>(), {}).value().decoded;
  }
  std::vector<Encounter> encounters;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::size_t j = i + 1; j < nodes.size(); ++j) {
      encounters.push_back({nodes[i].map, nodes[j].map, nodes[i].T_enu_node.inverse() * nodes[j].T_enu_node,
                            drawn_prior(nodes[i].T_enu_node, nodes[j].T_enu_node, 5.0, 0.05, 0.02,
                                        seed + static_cast<unsigned>(10 * i + j))});
    }
  }
  return encounters;
}

/// Six on a solar farm, six among trees.
const std::vector<Encounter>& encounters() {
  static const std::vector<Encounter> made = [] {
    std::vector<Encounter> all = encounters_on(farm_site("farm", {}), 1);
    for (Encounter& encounter : encounters_on(wild_site("wild", 2), 100)) all.push_back(std::move(encounter));
    return all;
  }();
  return made;
}

template <class Register>
void run(benchmark::State& state, Register register_one) {
  encounters();
  std::vector<double> errors;
  std::size_t tried = 0;
  for (auto _ : state) {
    for (const Encounter& encounter : encounters()) {
      const PoseError error = error_between(encounter.truth, register_one(encounter));
      ++tried;
      if (error.translation_m < 0.5 && error.rotation_rad < 2.0 * kDegree)
        errors.push_back(error.translation_m);
    }
  }
  std::sort(errors.begin(), errors.end());
  state.counters["right"] = static_cast<double>(errors.size()) / static_cast<double>(tried);
  state.counters["error_mm"] = errors.empty() ? 0.0 : 1e3 * errors[errors.size() / 2];
  state.counters["ms_each"] = benchmark::Counter(1e-3 * static_cast<double>(tried),
                                                 benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void with_prior(benchmark::State& state) {
  run(state,
      [](const Encounter& e) { return register_clouds(e.target, e.source, {}, e.prior).T_target_source; });
}
void without_prior(benchmark::State& state) {
  run(state, [](const Encounter& e) { return register_clouds(e.target, e.source, {}).T_target_source; });
}
void preparation(benchmark::State& state) {
  const RegistrationConfig config;
  run(state, [&](const Encounter& e) {
    benchmark::DoNotOptimize(PreparedCloud(e.target, Eigen::Vector3d::UnitZ(), config).size());
    return Pose::Identity();
  });
}

PclCloud::Ptr pcl_cloud(const cloud::PointCloud& cloud, float voxel_m) {
  auto out = std::make_shared<PclCloud>();
  const auto thin = voxel_downsample(cloud, voxel_m);
  const auto normals = estimate_normals(thin, cloud::KdTree(thin), {16, 2.0f, 5, Eigen::Vector3f::Zero()});
  for (std::size_t i = 0; i < thin.size(); ++i) {
    if (normals.normals[i].isZero()) continue;
    pcl::PointNormal point;
    point.getVector3fMap() = thin.points[i];
    point.getNormalVector3fMap() = normals.normals[i];
    out->push_back(point);
  }
  return out;
}

PclFeatures::Ptr pcl_fpfh(const PclCloud::Ptr& cloud) {
  pcl::FPFHEstimation<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33> fpfh;
  fpfh.setInputCloud(cloud);
  fpfh.setInputNormals(cloud);
  fpfh.setRadiusSearch(3.0);
  auto features = std::make_shared<PclFeatures>();
  fpfh.compute(*features);
  return features;
}

Pose pcl_register(const Encounter& encounter) {
  const auto a = pcl_cloud(encounter.target, 0.6f), b = pcl_cloud(encounter.source, 0.6f);
  pcl::SampleConsensusPrerejective<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33> global;
  global.setInputSource(b);
  global.setSourceFeatures(pcl_fpfh(b));
  global.setInputTarget(a);
  global.setTargetFeatures(pcl_fpfh(a));
  global.setMaximumIterations(4000);
  global.setNumberOfSamples(3);
  global.setCorrespondenceRandomness(2);
  global.setSimilarityThreshold(0.9f);
  global.setMaxCorrespondenceDistance(1.0);
  global.setInlierFraction(0.2f);
  PclCloud moved;
  global.align(moved);
  const auto fine_a = pcl_cloud(encounter.target, 0.3f), fine_b = pcl_cloud(encounter.source, 0.3f);
  pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal> fine;
  fine.setInputSource(fine_b);
  fine.setInputTarget(fine_a);
  fine.setMaxCorrespondenceDistance(1.0);
  fine.setMaximumIterations(24);
  fine.align(moved, global.getFinalTransformation());
  return Pose(fine.getFinalTransformation().cast<double>());
}

void pcl_whole(benchmark::State& state) { run(state, pcl_register); }

void spherization(benchmark::State& state) {
  static const cloud::PointCloud map = MadeWorld(7).scan(Pose::Identity(), 250'000, 0.02, 7, 60.0);
  for (auto _ : state) {
    const auto result = spherize(map, Eigen::Vector3f::UnitZ(), {});
    state.counters["bytes"] = static_cast<double>(result->bytes.size());
    state.counters["points"] = static_cast<double>(result->encoded);
  }
}

BENCHMARK(with_prior)->Unit(benchmark::kMillisecond);
BENCHMARK(without_prior)->Unit(benchmark::kMillisecond);
BENCHMARK(preparation)->Unit(benchmark::kMillisecond);
BENCHMARK(pcl_whole)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(spherization)->Unit(benchmark::kMillisecond);

}  // namespace
