// Voxel grids, k-d tree, normals, ground, outliers, Draco. Counters: bytes and points of what was encoded.
#include <benchmark/benchmark.h>

#include "cloud/scenes.hpp"
#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/cloud/encode_within.hpp"
#include "fleetmap/cloud/ground.hpp"
#include "fleetmap/cloud/kd_tree.hpp"
#include "fleetmap/cloud/normals.hpp"
#include "fleetmap/cloud/outliers.hpp"
#include "fleetmap/cloud/voxel_grid.hpp"

namespace {

using namespace fleetmap::cloud;
using fleetmap::cloud::testing::street_scene;

const PointCloud& scene(std::size_t count) {
  static const PointCloud small = street_scene(20'000, 1);
  static const PointCloud large = street_scene(200'000, 1);
  return count <= 20'000 ? small : large;
}

void voxel_grid(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(voxel_downsample(scene(200'000), 0.2f));
}
void tree_build(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(KdTree(scene(20'000)));
}
void tree_nearest(benchmark::State& state) {
  const KdTree tree(scene(20'000));
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(tree.nearest(scene(200'000).points[i++ % 200'000]));
}
void normals(benchmark::State& state) {
  const KdTree tree(scene(20'000));
  for (auto _ : state) benchmark::DoNotOptimize(estimate_normals(scene(20'000), tree, NormalConfig{}));
}
void ground(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(split_ground(scene(200'000), GroundConfig{}));
}
void outliers(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(split_outliers(scene(20'000), OutlierConfig{}));
}
void draco_encode(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(encode(scene(20'000), {0.05, false}));
}
void draco_decode(benchmark::State& state) {
  const auto bytes = *encode(scene(20'000), {0.05, false});
  for (auto _ : state) benchmark::DoNotOptimize(decode(bytes));
  state.counters["bytes"] = static_cast<double>(bytes.size());
}
void encode_into_25_kB(benchmark::State& state) {
  FitConfig config;
  config.voxel_over_resolution = static_cast<double>(state.range(0));
  for (auto _ : state) {
    const auto fitted = encode_within(scene(200'000), config);
    state.counters["bytes"] = static_cast<double>(fitted->bytes.size());
    state.counters["points"] = static_cast<double>(fitted->decoded.size());
    state.counters["voxel_m"] = static_cast<double>(fitted->voxel_m);
    state.counters["encodings"] = fitted->encodings;
  }
}

BENCHMARK(voxel_grid)->Unit(benchmark::kMillisecond);
BENCHMARK(tree_build)->Unit(benchmark::kMillisecond);
BENCHMARK(tree_nearest);
BENCHMARK(normals)->Unit(benchmark::kMillisecond);
BENCHMARK(ground)->Unit(benchmark::kMillisecond);
BENCHMARK(outliers)->Unit(benchmark::kMillisecond);
BENCHMARK(draco_encode)->Unit(benchmark::kMillisecond);
BENCHMARK(draco_decode)->Unit(benchmark::kMillisecond);
BENCHMARK(encode_into_25_kB)->Arg(2)->Arg(4)->Arg(6)->Arg(8)->Unit(benchmark::kMillisecond);

}  // namespace
