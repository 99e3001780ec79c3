// Registration of pairs on generated sites against what PCL and, where it is installed (libopen3d-dev),
// Open3D have for the same step, on the same clouds; CPU time of all threads. `global`: nothing is known;
// `start`: the pose is known to 0.3 m and 1.5 deg. Counters: share of pairs within 0.5 m and 2 deg of
// the truth, and the median error of those.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <random>

#include "bench/library_registration.hpp"
#include "fleetmap/registration/register_clouds.hpp"
#include "fleetmap/registration/spherize.hpp"
#include "registration/made_world.hpp"
#include "registration/pair_worlds.hpp"

namespace {

using namespace fleetmap;
using namespace fleetmap::registration;
using namespace fleetmap::registration::testing;

struct ClosePair {
  cloud::PointCloud target, source;
  Pose truth;
  Prior prior;
  Prior start;  ///< of a fine step
};

constexpr double kStartTranslation = 0.3;         // m, 1 sigma an axis
constexpr double kStartRotation = 1.5 * kDegree;  // 1 sigma an axis

Prior start_near(const Pose& truth, const Eigen::Vector3d& up_target, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> gauss;
  Vector6d push;
  for (int k = 0; k < 6; ++k) push[k] = (k < 3 ? kStartTranslation : kStartRotation) * gauss(random);
  return {truth * se3_exp(push), kStartTranslation, kStartRotation,
          kStartRotation,        kStartTranslation, up_target};
}

std::vector<ClosePair> close_pairs_on(const Site& site, unsigned seed) {
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
  std::vector<ClosePair> pairs;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::size_t j = i + 1; j < nodes.size(); ++j) {
      pairs.push_back({nodes[i].map,
                       nodes[j].map,
                       nodes[i].T_enu_node.inverse() * nodes[j].T_enu_node,
                       drawn_prior(nodes[i].T_enu_node, nodes[j].T_enu_node, 5.0, 0.05, 0.02,
                                   seed + static_cast<unsigned>(10 * i + j)),
                       {}});
      ClosePair& made = pairs.back();
      made.start = start_near(made.truth, nodes[i].T_enu_node.linear().transpose() * Eigen::Vector3d::UnitZ(),
                              seed + static_cast<unsigned>(10 * i + j));
    }
  }
  return pairs;
}

/// Six on a solar farm, six among trees.
const std::vector<ClosePair>& pairs() {
  static const std::vector<ClosePair> made = [] {
    std::vector<ClosePair> all = close_pairs_on(farm_site("farm", {}), 1);
    for (ClosePair& pair : close_pairs_on(wild_site("wild", 2), 100)) all.push_back(std::move(pair));
    return all;
  }();
  return made;
}

template <class Register>
void run(benchmark::State& state, Register register_one) {
  pairs();
  std::vector<double> errors;
  std::size_t tried = 0;
  for (auto _ : state) {
    for (const ClosePair& pair : pairs()) {
      const PoseError error = error_between(pair.truth, register_one(pair));
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
      [](const ClosePair& e) { return register_clouds(e.target, e.source, {}, e.prior).T_target_source; });
}
void without_prior(benchmark::State& state) {
  run(state, [](const ClosePair& e) { return register_clouds(e.target, e.source, {}).T_target_source; });
}
void preparation(benchmark::State& state) {
  const RegistrationConfig config;
  run(state, [&](const ClosePair& e) {
    benchmark::DoNotOptimize(PreparedCloud(e.target, Eigen::Vector3d::UnitZ(), config).size());
    return Pose::Identity();
  });
}

void from_start(benchmark::State& state) {
  run(state,
      [](const ClosePair& e) { return register_clouds(e.target, e.source, {}, e.start).T_target_source; });
}
void start_itself(benchmark::State& state) {
  run(state, [](const ClosePair& e) { return e.start.T_target_source; });
}
template <Pose (*method)(const cloud::PointCloud&, const cloud::PointCloud&)>
void library_global(benchmark::State& state) {
  run(state, [](const ClosePair& e) { return method(e.target, e.source); });
}
template <Pose (*method)(const cloud::PointCloud&, const cloud::PointCloud&, const Pose&)>
void library_start(benchmark::State& state) {
  run(state, [](const ClosePair& e) { return method(e.target, e.source, e.start.T_target_source); });
}

void spherization(benchmark::State& state) {
  static const cloud::PointCloud map = MadeWorld(7).scan(Pose::Identity(), 250'000, 0.02, 7, 60.0);
  for (auto _ : state) {
    const auto result = spherize(map, Eigen::Vector3f::UnitZ(), {});
    state.counters["bytes"] = static_cast<double>(result->bytes.size());
    state.counters["points"] = static_cast<double>(result->encoded);
  }
}

void once(benchmark::internal::Benchmark* benchmark) {
  benchmark->Unit(benchmark::kMillisecond)->Iterations(1)->MeasureProcessCPUTime();
}

BENCHMARK(with_prior)->Apply(once);
BENCHMARK(without_prior)->Name("global/fleetmap")->Apply(once);
BENCHMARK(library_global<bench::pcl_global>)->Name("global/pcl")->Apply(once);
#ifdef FLEETMAP_WITH_OPEN3D
BENCHMARK(library_global<bench::open3d_global>)->Name("global/open3d")->Apply(once);
#endif
BENCHMARK(start_itself)->Name("start/nothing")->Apply(once);
BENCHMARK(from_start)->Name("start/fleetmap")->Apply(once);
BENCHMARK(library_start<bench::pcl_icp>)->Name("start/pcl ICP with normals")->Apply(once);
BENCHMARK(library_start<bench::pcl_gicp>)->Name("start/pcl GICP")->Apply(once);
#ifdef FLEETMAP_WITH_OPEN3D
BENCHMARK(library_start<bench::open3d_icp>)->Name("start/open3d ICP point to plane")->Apply(once);
BENCHMARK(library_start<bench::open3d_gicp>)->Name("start/open3d GICP")->Apply(once);
#endif
BENCHMARK(preparation)->Apply(once);
BENCHMARK(spherization)->Unit(benchmark::kMillisecond);

}  // namespace
