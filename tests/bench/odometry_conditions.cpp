// Prints how the odometry fares under conditions that robots meet: speeds, turns, rough ground, a shaking
// mast, noise, rates and LiDARs. LiDAR alone with and without motion compensation, and with a gyro, on the
// same scans. A Markdown table.
//   bench_odometry_conditions [WORLD] [--seeds N] [--length M] [--only NAME]
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <numbers>
#include <string>
#include <vector>

#include "fleetmap/config/sensor_file.hpp"
#include "fleetmap/config/world_file.hpp"
#include "sim/lane_odometry.hpp"

namespace {

using namespace fleetmap;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kMast = 0.2 * kDegree;
const testing::DriveCondition kConditions[] = {
    {.name = "1 m/s"},
    {.name = "0.3 m/s", .speed = 0.3},
    {.name = "2 m/s", .speed = 2.0},
    {.name = "4 m/s", .speed = 4.0},
    {.name = "turns at 60 deg/s", .turn_rate = 60.0 * kDegree},
    {.name = "turns at 120 deg/s", .turn_rate = 120.0 * kDegree},
    {.name = "bumps of 3 deg", .speed = 1.5, .tilt = 3.0 * kDegree},
    {.name = "bumps of 3 deg, 3 m/s", .speed = 3.0, .tilt = 3.0 * kDegree},
    {.name = "mast 5 Hz, 3 mm, 0.2 deg", .shake = 5.0, .shake_way = 0.003, .shake_angle = kMast},
    {.name = "mast 12 Hz, 2 mm, 0.2 deg", .shake = 12.0, .shake_way = 0.002, .shake_angle = kMast},
    {.name = "mast 30 Hz, 1 mm, 0.2 deg", .shake = 30.0, .shake_way = 0.001, .shake_angle = kMast},
    {.name = "noise 1 cm", .noise = 0.01},
    {.name = "noise 5 cm", .noise = 0.05},
    {.name = "5 Hz", .rate = 5.0},
    {.name = "20 Hz", .rate = 20.0},
    {.name = "every fifth scan (2 Hz)", .every = 5},
    {.name = "half of the rays", .keep = 0.5},
    {.name = "HDL-32E", .lidar = "hdl-32e"},
    {.name = "OS1-64", .lidar = "os1-64"},
    {.name = "OS1-128", .lidar = "os1-128"},
    {.name = "Livox-like", .lidar = "livox-mid"},
};

constexpr testing::OdometryUse kUses[] = {
    {"LiDAR", true, false}, {"LiDAR, no motion compensation", false, false}, {"with gyro", true, true}};

/// The site of one seed, for all conditions.
struct Site {
  std::shared_ptr<const sim::World> world;
  std::shared_ptr<const sim::Scene> scene;
};

int print(const std::vector<Site>& sites, const testing::DriveCondition& how, double length) {
  const std::filesystem::path config = std::filesystem::path(FLEETMAP_SOURCE_DIR) / "config";
  auto lidar = config::load_lidar_spec(config / "sensors" / (std::string(how.lidar) + ".yaml"));
  if (!lidar) {
    std::printf("%s\n", lidar.error().message.c_str());
    return 1;
  }
  lidar->range_noise = how.noise;
  *lidar = sim::at_rate(*lidar, how.rate);
  std::vector<std::vector<testing::LaneOdometry>> all;
  for (std::size_t k = 0; k < sites.size(); ++k) {
    all.push_back(
        testing::odometry_of_lanes(*sites[k].world, *sites[k].scene, *lidar, how, length, k + 1, kUses));
  }
  for (std::size_t v = 0; v < std::size(kUses); ++v) {
    testing::LaneOdometry mean, worst;
    for (const auto& results : all) {
      mean.ate += results[v].ate / static_cast<double>(all.size());
      mean.drift += results[v].drift / static_cast<double>(all.size());
      mean.cpu_ms += results[v].cpu_ms / static_cast<double>(all.size());
      worst.ate = std::max(worst.ate, results[v].ate);
      worst.drift = std::max(worst.drift, results[v].drift);
      worst.lost += results[v].lost;
    }
    std::printf("| %s | %s | %.3f (%.3f) | %.3f (%.3f) | %llu | %.1f |\n", how.name, kUses[v].name, mean.ate,
                worst.ate, 100.0 * mean.drift, 100.0 * worst.drift,
                static_cast<unsigned long long>(worst.lost), mean.cpu_ms);
  }
  std::fflush(stdout);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::string world = "rolling_60", only;
  std::uint64_t seeds = 5;
  double length = 60.0;
  for (int i = 1; i < argc; ++i) {
    const bool more = i + 1 < argc;
    if (std::strcmp(argv[i], "--seeds") == 0 && more) {
      seeds = std::stoull(argv[++i]);
    } else if (std::strcmp(argv[i], "--length") == 0 && more) {
      length = std::stod(argv[++i]);
    } else if (std::strcmp(argv[i], "--only") == 0 && more) {
      only = argv[++i];
    } else {
      world = argv[i];
    }
  }
  std::vector<Site> sites;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const std::filesystem::path file =
        std::filesystem::path(FLEETMAP_SOURCE_DIR) / "config/worlds" / (world + ".yaml");
    const auto made = config::make_world(file, seed);
    const auto scene = made ? sim::Scene::create((*made)->mesh()) : tl::unexpected(made.error());
    if (!scene) {
      std::printf("%s\n", scene.error().message.c_str());
      return 1;
    }
    sites.push_back({*made, *scene});
  }
  std::printf(
      "| condition | used | ATE m, mean (worst) | drift over 20 m %%, mean (worst) | lost scans | CPU ms |\n"
      "|---|---|---|---|---|---|\n");
  for (const testing::DriveCondition& how : kConditions) {
    if (!only.empty() && std::string(how.name).find(only) == std::string::npos) continue;
    if (const int failed = print(sites, how, length); failed != 0) return failed;
  }
  return 0;
}
