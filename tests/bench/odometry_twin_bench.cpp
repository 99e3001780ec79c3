// Prints how true the odometry is on drives through the digital twin's farms, as a Markdown table.
//   bench_odometry_twin [WORLD[:SEED] ...] [--sensors a,b] [--length M]
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <memory>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "bench/twin_drive.hpp"
#include "fleetmap/config/sensor_file.hpp"
#include "fleetmap/config/world_file.hpp"
#include "fleetmap/core/cpu_time.hpp"
#include "fleetmap/odometry/loam.hpp"
#include "fleetmap/odometry/motion_covariance.hpp"
#include "odometry/trajectory_error.hpp"

namespace {

using namespace fleetmap;

struct Variant {
  const char* name;
  bool imu, wheels;
  double keep = 1.0;  ///< share of the rays
  bool deskew = true;
};
constexpr Variant kVariants[] = {{"LiDAR", false, false},
                                 {"LiDAR, not de-skewed", false, false, 1.0, false},
                                 {"LiDAR, half of the rays", false, false, 0.5},
                                 {"with IMU", true, false},
                                 {"with wheels", false, true},
                                 {"with IMU and wheels", true, true}};

odometry::LoamConfig config_of(odometry::LoamConfig config, const Variant& variant) {
  config.deskew = variant.deskew;
  return config;
}

/// One odometry that listens to a drive.
struct Run {
  Run(const odometry::LoamConfig& config, const odometry::LidarModel& model, const Variant& v)
      : variant(v), loam(config_of(config, v), model) {}

  void add(const sensor::Scan& scan, const Pose& T_enu_base) {
    sensor::Scan thinned;
    if (variant.keep < 1.0) {
      thinned = scan;
      std::erase_if(thinned.points,
                    [this](const sensor::ScanPoint&) { return uniform(random) > variant.keep; });
    }
    const double before = thread_cpu_seconds();
    const auto update = loam.add_scan(variant.keep < 1.0 ? thinned : scan);
    cpu_ms.push_back(1e3 * (thread_cpu_seconds() - before));
    windows = std::max(windows, loam.map_size().windows);
    if (!update) return;
    estimate.push_back(update->T_odom_base);
    covariance.push_back(update->covariance);
    noise.push_back(update->pose_noise);
    truth.push_back(T_enu_base);
  }

  Variant variant;
  odometry::Loam loam;
  std::mt19937_64 random{7};
  std::uniform_real_distribution<double> uniform{0.0, 1.0};
  std::vector<Pose> estimate, truth;
  std::vector<Matrix6d> covariance, noise;
  std::vector<double> cpu_ms;
  std::size_t windows = 0;  ///< of the local map, at most
};

struct Errors {
  double drift = 0.0;     ///< mean, share of the length
  double worst = 0.0;     ///< share of the length
  double rotation = 0.0;  ///< mean, rad/m
  double nees = 0.0;      ///< mean of e^T C^-1 e / 6
  std::size_t count = 0;
};

/// Over all pieces of `length` m, one starting every half metre.
Errors errors_over(const Run& run, double length) {
  std::vector<double> path{0.0};
  for (std::size_t i = 1; i < run.truth.size(); ++i) {
    path.push_back(path.back() + (run.truth[i].translation() - run.truth[i - 1].translation()).norm());
  }
  Errors errors;
  double next = 0.0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (path[i] < next) continue;
    next = path[i] + 0.5;
    odometry::MotionCovariance motion;
    motion.add(run.estimate[i], run.covariance[i], run.noise[i]);
    std::size_t j = i;
    while (j < path.size() && path[j] - path[i] < length) {
      if (++j == path.size()) break;
      motion.add(run.estimate[j], run.covariance[j], run.noise[j]);
    }
    if (j == path.size()) break;
    const Matrix6d C = motion.since_reference();
    const Pose E =
        (run.truth[i].inverse() * run.truth[j]).inverse() * (run.estimate[i].inverse() * run.estimate[j]);
    const Vector6d e = se3_log(E);
    const double share = E.translation().norm() / length;
    errors.drift += share;
    errors.worst = std::max(errors.worst, share);
    errors.rotation += e.tail<3>().norm() / length;
    errors.nees += e.dot(C.ldlt().solve(e)) / 6.0;
    ++errors.count;
  }
  const double n = std::max(1.0, static_cast<double>(errors.count));
  errors.drift /= n;
  errors.rotation /= n;
  errors.nees /= n;
  return errors;
}

void print(const std::string& world, const std::string& sensor, const Run& run) {
  const Errors e = errors_over(run, 20.0);
  std::vector<double> ms = run.cpu_ms;
  std::sort(ms.begin(), ms.end());
  double mean = 0.0;
  for (const double t : ms) mean += t / static_cast<double>(ms.size());
  std::printf("| %s | %s | %s | %zu | %llu | %.4f | %.3f %% | %.3f %% | %.4f | %.2f / %.2f |", world.c_str(),
              sensor.c_str(), run.variant.name, run.truth.size(),
              static_cast<unsigned long long>(run.loam.counters().lost),
              testing::aligned_rmse(run.estimate, run.truth), 100.0 * e.drift, 100.0 * e.worst,
              e.rotation * 180.0 / std::numbers::pi, mean, ms[ms.size() * 99 / 100]);
  for (const double length : {4.0, 20.0, 100.0}) {
    std::printf(" %.2f |", length == 20.0 ? e.nees : errors_over(run, length).nees);
  }
  std::printf(" %zu |\n", run.windows);
  std::fflush(stdout);
}

int drive(const std::string& world_name, const std::string& sensor_name, double length) {
  const std::filesystem::path config = std::filesystem::path(FLEETMAP_SOURCE_DIR) / "config";
  const auto colon = world_name.find(':');
  const std::uint64_t seed = colon == std::string::npos ? 1 : std::stoull(world_name.substr(colon + 1));
  const auto world = config::make_world(config / "worlds" / (world_name.substr(0, colon) + ".yaml"), seed);
  const auto lidar = config::load_lidar_spec(config / "sensors" / (sensor_name + ".yaml"));
  if (!world || !lidar) {
    std::printf("%s\n", (world ? lidar.error() : world.error()).message.c_str());
    return 1;
  }
  const auto scene = sim::Scene::create((*world)->mesh());
  const sim::RobotTwinConfig robot = testing::drive_robot(*lidar, seed);

  odometry::LoamConfig loam;
  loam.T_base_lidar = robot.T_base_lidar;
  loam.q_base_imu = Eigen::Quaterniond(robot.T_base_imu.linear());
  std::vector<std::unique_ptr<Run>> runs;
  for (const Variant& v : kVariants)
    runs.push_back(std::make_unique<Run>(loam, *odometry::lidar_model(lidar->model), v));

  testing::TwinDrive twin(*world, *scene, robot, testing::first_lane_of(seed), length);
  testing::TwinDrive::Listener listener;
  listener.imu = [&](const sensor::Imu& imu) {
    for (auto& run : runs) {
      if (run->variant.imu) run->loam.add_imu(imu);
    }
  };
  listener.wheel = [&](const sensor::Wheel& wheel) {
    for (auto& run : runs) {
      if (run->variant.wheels) run->loam.add_wheel(wheel);
    }
  };
  listener.scan = [&](const sensor::Scan& scan, const Pose& T_enu_base) {
    for (auto& run : runs) run->add(scan, T_enu_base);
  };
  if (!twin.run(listener)) std::printf("%s: the robot got stuck\n", world_name.c_str());
  for (const auto& run : runs) print(world_name, sensor_name, *run);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> worlds, sensors;
  double length = 280.0;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--sensors") == 0 && i + 1 < argc) {
      std::stringstream list(argv[++i]);
      for (std::string name; std::getline(list, name, ',');) sensors.push_back(name);
    } else if (std::strcmp(argv[i], "--length") == 0 && i + 1 < argc) {
      length = std::stod(argv[++i]);
    } else {
      worlds.push_back(argv[i]);
    }
  }
  if (worlds.empty()) worlds = {"farm_60:1", "farm_200:1", "farm_200:2", "rolling_200:3"};
  if (sensors.empty()) sensors = {"vlp16", "os1-64", "livox-mid"};
  std::printf(
      "| world:seed | LiDAR | used | scans | said to be lost | ATE m | drift over 20 m | worst | deg/m | CPU "
      "ms mean / "
      "p99 | NEES/6 over 4 m | 20 m | 100 m | windows "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const std::string& world : worlds) {
    for (const std::string& sensor : sensors) {
      if (const int failed = drive(world, sensor, length); failed != 0) return failed;
    }
  }
  return 0;
}
