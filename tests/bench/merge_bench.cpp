#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "fleetmap/cloud/cloud_writer.hpp"
#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/core/cpu_time.hpp"
#include "fleetmap/core/file_hash.hpp"
#include "fleetmap/store/store.hpp"
#include "fleetmap/store/submap_loader.hpp"
#include "fleetmap/store/tiled_merge.hpp"
#include "store/items.hpp"

/// The final merge of a large site, from a store on disk into a PLY:
///   bench_merge make STORE SUBMAPS    synthetic submaps of 90,000 points along lanes of a square site
///   bench_merge tiled|whole STORE OUT.ply [SUBMAPS]    of the first ones
/// A process a measurement, since the peak of its memory is measured.
namespace fleetmap {
namespace {

constexpr std::size_t kPoints = 90'000;  // of a submap
constexpr double kStep = 5.0;            // m, between nodes
constexpr double kLane = 20.0;           // m, between lanes
constexpr float kReach = 30.0f;          // m, of a submap
constexpr store::MergeConfig kConfig{.voxel_m = 0.1};

struct Cost {
  double cpu = process_cpu_seconds();
  double seconds() const { return process_cpu_seconds() - cpu; }
};

/// MB, the most that was resident.
double peak_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// Nodes of lanes driven to and fro over a square of about kStep x kLane metres a node.
std::map<NodeId, Pose> poses(const store::Store& store, std::size_t max_nodes) {
  const std::size_t count = std::min(max_nodes, store.nodes().size());
  const auto per_lane =
      static_cast<std::uint32_t>(std::sqrt(static_cast<double>(count) * kStep * kLane) / kStep);
  std::map<NodeId, Pose> T_enu_node;
  for (const auto& [id, node] : store.nodes()) {
    if (T_enu_node.size() == count) break;
    const std::uint32_t lane = id.seq / per_lane, at = id.seq % per_lane;
    const double x = kStep * (lane % 2 == 0 ? at : per_lane - 1 - at);
    const double yaw = lane % 2 == 0 ? 0.0 : std::numbers::pi;
    T_enu_node[id] = make_pose(rotation_from_rpy(0.0, 0.0, yaw), {x, kLane * lane, 0.0});
  }
  return T_enu_node;
}

/// Rolling ground, and what stands on it up to 3 m, all within reach; denser near the robot.
cloud::PointCloud submap(std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  cloud::PointCloud cloud;
  for (std::size_t k = 0; k < kPoints; ++k) {
    const float r = kReach * std::sqrt(uniform(random));
    const float angle = 2.0f * std::numbers::pi_v<float> * uniform(random);
    const float height = k % 2 == 0 ? 0.05f * uniform(random) : 3.0f * uniform(random);
    cloud.points.emplace_back(r * std::cos(angle), r * std::sin(angle), height);
  }
  return cloud;
}

int make(const std::filesystem::path& file, std::uint32_t submaps) {
  store::StoreConfig config;
  config.power_safe = false;
  auto store = store::Store::open(file, testing::agent("r1"), config).value();
  std::mt19937 random(1);
  for (std::uint32_t seq = 0; seq < submaps; ++seq) {
    const Bytes encoded = cloud::encode(submap(random), {}).value();
    const graph::Node node = testing::make_node(testing::agent("r1"), seq, encoded);
    if (const auto put = store.put_node_with_submap(node, encoded); !put || *put != store::Put::kAdded) {
      std::cerr << "submap " << seq << " was not stored\n";
      return 1;
    }
  }
  std::printf("%u submaps, %.0f MB\n", submaps, static_cast<double>(std::filesystem::file_size(file)) / 1e6);
  return 0;
}

int tiled(store::Store& store, const std::filesystem::path& out, std::size_t max_nodes) {
  const Cost cost;
  auto merge =
      store::TiledMerge::plan(poses(store, max_nodes), store::decoded_submaps(store), kConfig).value();
  const double planned = cost.seconds();
  auto writer = cloud::CloudWriter::create(out, merge.outline().has_intensities).value();
  const Status streamed = merge.stream([&](const store::MapTile& tile) { return writer.add(tile.cloud); });
  if (!streamed || !writer.finish()) return 1;
  const double merged = cost.seconds();
  const std::string hash = to_hex(file_hash(out).value());
  const store::TiledMergeStats stats = merge.stats();
  const auto submaps = static_cast<double>(merge.outline().submaps);
  std::printf("tiled: %zu submaps, %zu points in, %zu out, %zu tiles, largest %zu, %.2f loads a submap\n",
              merge.outline().submaps, merge.outline().points_in, writer.points(), merge.tiles(),
              stats.largest_tile, static_cast<double>(stats.loads) / submaps);
  std::printf("CPU %.1f s: plan %.1f, merge and write %.1f, hash %.1f; peak %.0f MB; %s\n", cost.seconds(),
              planned, merged - planned, cost.seconds() - merged, peak_mb(), hash.c_str());
  return 0;
}

int whole(store::Store& store, const std::filesystem::path& out, std::size_t max_nodes) {
  const Cost cost;
  const store::MergedMap map = store::merge(poses(store, max_nodes), store::decoded_submaps(store), kConfig);
  auto writer = cloud::CloudWriter::create(out, map.cloud.has_intensities()).value();
  if (!writer.add(map.cloud) || !writer.finish()) return 1;
  std::printf("whole: %zu submaps, %zu points in, %zu out; CPU %.1f s; peak %.0f MB\n", map.submaps,
              map.points_in, map.cloud.size(), cost.seconds(), peak_mb());
  return 0;
}

int run(const std::vector<std::string>& arguments) {
  const auto number = [&](std::size_t i) { return static_cast<std::uint32_t>(std::stoul(arguments[i])); };
  const std::string what = arguments.empty() ? "" : arguments[0];
  if (what == "make" && arguments.size() == 3) return make(arguments[1], number(2));
  if ((what != "tiled" && what != "whole") || arguments.size() < 3 || arguments.size() > 4) {
    std::cerr << "bench_merge make STORE SUBMAPS | tiled|whole STORE OUT.ply [SUBMAPS]\n";
    return 2;
  }
  auto store = store::Store::open_read_only(arguments[1]);
  if (!store) {
    std::cerr << store.error().message << '\n';
    return 1;
  }
  const std::size_t max_nodes = arguments.size() == 4 ? number(3) : store->nodes().size();
  return what == "tiled" ? tiled(*store, arguments[2], max_nodes) : whole(*store, arguments[2], max_nodes);
}

}  // namespace
}  // namespace fleetmap

int main(int argc, char** argv) { return fleetmap::run({argv + 1, argv + argc}); }
