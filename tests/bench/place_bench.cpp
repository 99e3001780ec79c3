// Global ball tree against a linear scan with haversine_distance.
// "rows": fleet nodes 5 m apart along rows 8 m apart, in the order in which a robot drives them; "globe":
// uniform.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "fleetmap/place/ball_tree.hpp"

namespace fleetmap::place {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kMetre = 1.0 / kMeanEarthRadius;

std::vector<GeoPoint> along_rows(std::size_t count) {
  std::mt19937 random(1);
  std::normal_distribution<double> jitter(0.0, 0.5 * kMetre);
  const auto columns =
      static_cast<std::size_t>(std::max(1.0, std::sqrt(static_cast<double>(count) * 8.0 / 5.0)));
  std::vector<GeoPoint> points;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t row = i / columns;
    const std::size_t column = row % 2 == 0 ? i % columns : columns - 1 - i % columns;
    points.push_back({0.71 + 8.0 * kMetre * static_cast<double>(row) + jitter(random),
                      -1.3 + 5.0 * kMetre / std::cos(0.71) * static_cast<double>(column) + jitter(random),
                      0.0});
  }
  return points;
}

std::vector<GeoPoint> over_the_globe(std::size_t count, unsigned seed = 2) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> z(-1.0, 1.0);
  std::uniform_real_distribution<double> longitude(-kPi, kPi);
  std::vector<GeoPoint> points;
  for (std::size_t i = 0; i < count; ++i) points.push_back({std::asin(z(random)), longitude(random), 0.0});
  return points;
}

std::vector<GeoPoint> make_points(const benchmark::State& state) {
  const auto count = static_cast<std::size_t>(state.range(0));
  return state.range(1) == 0 ? along_rows(count) : over_the_globe(count);
}

/// Places near the nodes for the site, anywhere for the globe; in random order, so that nothing is in the
/// cache by luck.
std::vector<GeoPoint> make_queries(const benchmark::State& state, const std::vector<GeoPoint>& points) {
  if (state.range(1) == 1) return over_the_globe(4096, 3);
  std::mt19937 random(4);
  std::normal_distribution<double> offset(0.0, 10.0 * kMetre);
  std::vector<GeoPoint> queries;
  for (int i = 0; i < 4096; ++i) {
    GeoPoint p = points[random() % points.size()];
    p.latitude += offset(random);
    p.longitude += offset(random);
    queries.push_back(p);
  }
  return queries;
}

BallTree tree_of(const std::vector<GeoPoint>& points) {
  BallTree tree;
  for (const GeoPoint& point : points) tree.insert(point);
  return tree;
}

void BM_insert(benchmark::State& state) {
  const auto points = make_points(state);
  for (auto _ : state) benchmark::DoNotOptimize(tree_of(points).size());
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

void BM_nearest(benchmark::State& state) {
  const auto points = make_points(state);
  const auto queries = make_queries(state, points);
  const BallTree tree = tree_of(points);
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(tree.nearest(queries[i++ % queries.size()]));
}

void BM_within_30_m(benchmark::State& state) {
  const auto points = make_points(state);
  const auto queries = make_queries(state, points);
  const BallTree tree = tree_of(points);
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(tree.within(queries[i++ % queries.size()], 30.0));
}

void BM_ten_nearest(benchmark::State& state) {
  const auto points = make_points(state);
  const auto queries = make_queries(state, points);
  const BallTree tree = tree_of(points);
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(tree.k_nearest(queries[i++ % queries.size()], 10));
}

void BM_nearest_by_linear_scan(benchmark::State& state) {
  const auto points = make_points(state);
  const auto queries = make_queries(state, points);
  std::size_t i = 0;
  for (auto _ : state) {
    const GeoPoint& query = queries[i++ % queries.size()];
    Neighbor best{0, haversine_distance(query, points[0])};
    for (std::size_t k = 1; k < points.size(); ++k) {
      const double distance = haversine_distance(query, points[k]);
      if (distance < best.distance) best = {k, distance};
    }
    benchmark::DoNotOptimize(best);
  }
}

void sizes(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"nodes", "globe"});
  for (const std::int64_t globe : {0, 1}) {
    for (std::int64_t nodes = 100; nodes <= 1000000; nodes *= 10) bench->Args({nodes, globe});
  }
}

BENCHMARK(BM_insert)->Apply(sizes)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_nearest)->Apply(sizes)->Unit(benchmark::kNanosecond);
BENCHMARK(BM_within_30_m)->Apply(sizes)->Unit(benchmark::kNanosecond);
BENCHMARK(BM_ten_nearest)->Apply(sizes)->Unit(benchmark::kNanosecond);
BENCHMARK(BM_nearest_by_linear_scan)->Apply(sizes)->Unit(benchmark::kNanosecond);

}  // namespace
}  // namespace fleetmap::place
