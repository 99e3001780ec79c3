#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <numbers>
#include <random>
#include <string>

#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/store/store.hpp"
#include "store/items.hpp"

/// Writes a store for tests/bench/monitor_page.mjs: four robots that drove lanes of a square site.
///   bench_monitor_store DIR SUBMAPS POINTS    into DIR/r1/store.db; POINTS of each submap
namespace fleetmap {
namespace {

constexpr double kStep = 5.0;         // m, between nodes
constexpr double kLane = 20.0;        // m, between lanes
constexpr double kReach = 30.0;       // m, of a submap
constexpr double kTrees = 4.0;        // m, from tree to tree
constexpr double kNoise = 0.02;       // m, of a range
constexpr std::uint32_t kRobots = 4;  // each drives a quarter of the lanes
constexpr float kBrightest = 255.0f;  // as LiDARs count

/// Rolling ground.
double ground(const Eigen::Vector2d& p) { return 1.5 * std::sin(p.x() / 60.0) * std::cos(p.y() / 45.0); }

/// A scan from `at` (ENU, m) in an orchard: ground, and crowns in rows along x; denser near it.
cloud::PointCloud orchard(const Eigen::Vector3d& at, std::size_t points, std::mt19937& random) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::normal_distribution<double> noise(0.0, kNoise);
  cloud::PointCloud cloud;
  for (std::size_t k = 0; k < points; ++k) {
    const double r = kReach * share(random), angle = 2.0 * std::numbers::pi * share(random);
    Eigen::Vector3d p(at.x() + r * std::cos(angle), at.y() + r * std::sin(angle), 0.0);
    const bool crown = k % 2 == 0;
    if (crown) {
      p.x() = kTrees * std::round(p.x() / kTrees) + 1.2 * (share(random) - 0.5);
      p.y() = kTrees * std::round(p.y() / kTrees) + 1.2 * (share(random) - 0.5);
    }
    p.z() = ground(p.head<2>()) + (crown ? 3.5 * share(random) : 0.0) + noise(random);
    cloud.points.push_back((p - at).cast<float>());
    cloud.intensities.push_back(kBrightest * static_cast<float>(share(random)));
  }
  return cloud;
}

graph::Node node_at(const NodeId& id, const Eigen::Vector3d& at, const LocalFrame& enu, const Bytes& submap) {
  graph::Node node;
  node.id = id;
  node.stamp = stamp_from_ns(1'795'630'359'000'000'000 + std::int64_t{id.seq} * 5'000'000'000);
  node.T_odom_base = make_pose(Eigen::Matrix3d::Identity(), at);
  node.odom_covariance = 1e-4 * Matrix6d::Identity();
  node.G.emplace();
  node.G->stamp = node.stamp;
  node.G->position = enu.to_geo(at);
  node.G->covariance = 1e-2 * Matrix6d::Identity();
  node.submap_hash = content_hash(submap);
  node.submap_bytes = static_cast<std::uint32_t>(submap.size());
  return node;
}

int write(const std::filesystem::path& folder, std::uint32_t submaps, std::size_t points) {
  std::filesystem::create_directories(folder / "r1");
  store::StoreConfig config;
  config.power_safe = false;
  auto store = store::Store::open(folder / "r1" / "store.db", testing::agent("r1"), config).value();
  const LocalFrame enu(geo_point_from_degrees(39.0, -3.0, 600.0));
  const auto per_lane =
      static_cast<std::uint32_t>(std::sqrt(static_cast<double>(submaps) * kStep * kLane) / kStep);
  std::mt19937 random(1);
  for (std::uint32_t k = 0; k < submaps; ++k) {
    const std::uint32_t lane = k / per_lane;
    const Eigen::Vector2d plan(kStep * (k % per_lane), kLane * lane);
    const Eigen::Vector3d at(plan.x(), plan.y(), ground(plan) + 1.0);
    const Bytes submap = cloud::encode(orchard(at, points, random), {}).value();
    const NodeId id{testing::agent("r" + std::to_string(1 + k * kRobots / submaps)), k};
    const auto put = store.put_node_with_submap(node_at(id, at, enu, submap), submap);
    if (!put || *put != store::Put::kAdded) return EXIT_FAILURE;
  }
  std::cout << submaps << " submaps of " << points << " points\n";
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace fleetmap

int main(int argc, char** argv) {
  if (argc == 4)
    return fleetmap::write(argv[1], static_cast<std::uint32_t>(std::stoul(argv[2])), std::stoul(argv[3]));
  std::cerr << "usage: " << argv[0] << " DIR SUBMAPS POINTS\n";
  return EXIT_FAILURE;
}
