// Prints how the odometry fares under conditions that robots meet: speeds, turns, rough ground, a shaking
// mast, noise, rates and LiDARs. LiDAR alone with and without motion compensation, and with a gyro, on the
// same scans. A Markdown table.
//   bench_odometry_conditions [WORLD] [--seeds N] [--length M] [--only NAME]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "fleetmap/config/sensor_file.hpp"
#include "fleetmap/config/world_config.hpp"
#include "fleetmap/core/cpu_time.hpp"
#include "fleetmap/odometry/loam.hpp"
#include "fleetmap/sim/robot_twin.hpp"
#include "fleetmap/sim/scene.hpp"
#include "fleetmap/sim/world.hpp"
#include "odometry/trajectory_error.hpp"

namespace {

using namespace fleetmap;

constexpr double kPi = std::numbers::pi;
constexpr double kStep = 0.001;  // s, of the true poses: a mast that shakes at 30 Hz is followed
constexpr double kDegree = kPi / 180.0;

struct Condition {
  const char* name;
  double speed = 1.0;           ///< m/s
  double turn_rate = 0.8;       ///< rad/s, on the spot at the ends of lanes
  double tilt = 0.0;            ///< rad, amplitude of bumps some metres long
  double shake = 0.0;           ///< Hz, of the mast
  double shake_way = 0.0;       ///< m, amplitude
  double shake_angle = 0.0;     ///< rad, amplitude
  double noise = 0.02;          ///< m, of a range
  double rate = 10.0;           ///< Hz, of the LiDAR
  int every = 1;                ///< of its scans are used
  double keep = 1.0;            ///< share of its rays
  const char* lidar = "vlp16";  ///< of config/sensors
};
constexpr double kMast = 0.2 * kDegree;
const Condition kConditions[] = {
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

/// A drive up and down the lanes of a world, as base_link's pose at every kStep.
class Drive {
 public:
  Drive(const sim::World& world, const Condition& how, double length, std::uint64_t seed)
      : world_(world), how_(how), random_(seed) {
    std::uniform_real_distribution<double> phase(0.0, 2.0 * kPi);
    for (double& p : phases_) p = phase(random_);
    const auto& lanes = world.aisles();
    std::size_t lane = seed % std::max<std::size_t>(1, lanes.size() / 2);
    std::vector<Eigen::Vector2d> path;
    for (double way = 0.0; way < length && lane < lanes.size(); ++lane) {
      const Eigen::Vector2d along = lanes[lane].to - lanes[lane].from;
      const bool out = path.size() % 4 == 0;
      const Eigen::Vector2d begin = lanes[lane].from + 0.1 * along, end = lanes[lane].to - 0.02 * along;
      path.push_back(out ? begin : end);
      path.push_back(out ? end : begin);
      way += 0.88 * along.norm();
    }
    follow(path);
  }

  double duration() const { return kStep * static_cast<double>(planar_.size() - 1); }
  Pose base(std::size_t step) const { return on_ground(planar_[std::min(step, planar_.size() - 1)]); }
  /// What the mast does to the LiDAR, in base_link.
  Pose shaken(std::size_t step) const {
    if (how_.shake <= 0.0) return Pose::Identity();
    const double a = 2.0 * kPi * how_.shake * kStep * static_cast<double>(step);
    const Eigen::Vector3d way(std::sin(a + phases_[0]), std::sin(1.1 * a + phases_[1]),
                              0.5 * std::sin(0.9 * a + phases_[2]));
    const Eigen::Vector3d turn(std::sin(1.05 * a + phases_[3]), std::sin(a + phases_[4]),
                               0.5 * std::sin(0.95 * a + phases_[5]));
    Vector6d d;
    d << how_.shake_way * way, how_.shake_angle * turn;
    return se3_exp(d);
  }

 private:
  struct Planar {
    Eigen::Vector2d at;
    double yaw, way;
  };

  /// Straight to each corner, with a stop of a second at the start; corners are turned on the spot.
  void follow(const std::vector<Eigen::Vector2d>& path) {
    const double acceleration = std::max(1.0, how_.speed), angular = 5.0;
    const auto toward = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
      return std::atan2(b.y() - a.y(), b.x() - a.x());
    };
    Planar now{path[0], toward(path[0], path[1]), 0.0};
    for (double t = 0.0; t < 1.0; t += kStep) planar_.push_back(now);
    for (std::size_t corner = 1; corner < path.size(); ++corner) {
      const double turn = wrap_angle(toward(now.at, path[corner]) - now.yaw);
      const double begin = now.yaw;
      ramp(std::abs(turn), how_.turn_rate, angular, [&](double done) {
        now.yaw = begin + std::copysign(done, turn);
        planar_.push_back(now);
      });
      const Eigen::Vector2d from = now.at, direction = (path[corner] - from).normalized();
      const double way = now.way;
      ramp((path[corner] - from).norm(), how_.speed, acceleration, [&](double done) {
        now.at = from + done * direction;
        now.way = way + done;
        planar_.push_back(now);
      });
    }
  }

  /// From rest to rest over `distance`, at most at `rate`.
  template <class Visit>
  static void ramp(double distance, double rate, double acceleration, Visit visit) {
    double speed = 0.0, done = 0.0;
    while (done < distance - 1e-9) {
      const double brake = std::sqrt(2.0 * acceleration * (distance - done));
      speed = std::min({speed + acceleration * kStep, rate, std::max(brake, 1e-3)});
      done = std::min(distance, done + speed * kStep);
      visit(done);
    }
  }

  Pose on_ground(const Planar& p) const {
    const Eigen::Vector2d ahead(std::cos(p.yaw), std::sin(p.yaw)), left(-ahead.y(), ahead.x());
    constexpr double kHalf = 0.3;  // m, half of a wheelbase
    const auto height = [&](const Eigen::Vector2d& at) { return world_.ground_height(at); };
    const double pitch = -std::atan2(height(p.at + kHalf * ahead) - height(p.at - kHalf * ahead), 2 * kHalf);
    const double roll = std::atan2(height(p.at + kHalf * left) - height(p.at - kHalf * left), 2 * kHalf);
    const double bump_pitch = how_.tilt * (std::sin(2 * kPi * p.way / 3.1 + phases_[6]) +
                                           0.5 * std::sin(2 * kPi * p.way / 1.3 + phases_[7]));
    const double bump_roll =
        0.6 * how_.tilt *
        (std::sin(2 * kPi * p.way / 2.3 + phases_[8]) + 0.5 * std::sin(2 * kPi * p.way / 0.9 + phases_[9]));
    return make_pose(rotation_from_rpy(roll + bump_roll, pitch + bump_pitch, p.yaw),
                     {p.at.x(), p.at.y(), height(p.at) + 0.1});
  }

  const sim::World& world_;
  Condition how_;
  std::mt19937_64 random_;
  double phases_[10] = {};
  std::vector<Planar> planar_;
};

struct Variant {
  const char* name;
  bool deskew, gyro;
};
constexpr Variant kVariants[] = {
    {"LiDAR", true, false}, {"LiDAR, no motion compensation", false, false}, {"with gyro", true, true}};

struct Result {
  double ate = 0.0, drift = 0.0, cpu_ms = 0.0;
  std::uint64_t lost = 0;
};

/// One drive; the three variants see the same scans.
std::vector<Result> run(const sim::World& world, const sim::Scene& scene, const sim::LidarSpec& lidar,
                        const Condition& how, double length, std::uint64_t seed) {
  const Drive drive(world, how, length, seed);
  const Pose T_base_lidar = make_pose(rotation_from_rpy(0.0, 0.02, 0.0), {0.1, 0.0, 0.6});
  odometry::LoamConfig config;
  config.T_base_lidar = T_base_lidar;
  config.range_noise = std::max(0.02, how.noise);
  std::vector<odometry::Loam> loams;
  for (const Variant& v : kVariants) {
    config.deskew = v.deskew;
    loams.emplace_back(config, *odometry::lidar_model(lidar.model));
  }
  std::vector<std::vector<Pose>> estimates(std::size(kVariants));
  std::vector<Pose> truth;
  std::vector<Result> results(std::size(kVariants));
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const double period = 1.0 / lidar.rate;
  double fed = 0.0;
  for (std::uint64_t k = 0; period * static_cast<double>(k + 1) < drive.duration(); ++k) {
    const double begin = period * static_cast<double>(k);
    const auto first = static_cast<std::size_t>(begin / kStep);
    sim::ScanJob job{Stamp{from_seconds(begin)}, from_seconds(kStep), {}, k, seed};
    for (std::size_t step = 0; static_cast<double>(step) * kStep <= period + kStep; ++step) {
      job.T_enu_lidar.push_back(drive.base(first + step) * drive.shaken(first + step) * T_base_lidar);
    }
    for (; fed < begin + period + 0.02; fed += 0.01) {
      // The IMU stands on the chassis, below the mast.
      const auto at = static_cast<std::size_t>(fed / kStep);
      sensor::Imu imu;
      imu.stamp = Stamp{from_seconds(fed)};
      imu.angular_velocity =
          so3_log(drive.base(at).linear().transpose() * drive.base(at + 5).linear()) / (5 * kStep) +
          Eigen::Vector3d(0.003, -0.002, 0.004) +
          0.003 * Eigen::Vector3d(normal(random), normal(random), normal(random));
      loams.back().add_imu(imu);
    }
    if (k % static_cast<std::uint64_t>(how.every) != 0) continue;
    sensor::Scan scan = sim::cast_scan(scene, lidar, job);
    if (how.keep < 1.0) std::erase_if(scan.points, [&](const auto&) { return uniform(random) > how.keep; });
    truth.push_back(drive.base(first));
    for (std::size_t v = 0; v < loams.size(); ++v) {
      const double before = thread_cpu_seconds();
      const auto update = loams[v].add_scan(scan);
      results[v].cpu_ms += 1e3 * (thread_cpu_seconds() - before);
      estimates[v].push_back(update ? update->T_odom_base : estimates[v].back());
    }
  }
  for (std::size_t v = 0; v < loams.size(); ++v) {
    results[v].ate = testing::aligned_rmse(estimates[v], truth);
    results[v].drift = testing::relative_drift(estimates[v], truth, 20.0);
    results[v].cpu_ms /= static_cast<double>(truth.size());
    results[v].lost = loams[v].counters().lost;
  }
  return results;
}

/// The site of one seed, for all conditions.
struct Site {
  std::shared_ptr<const sim::World> world;
  std::shared_ptr<const sim::Scene> scene;
};

int print(const std::vector<Site>& sites, const Condition& how, double length) {
  const std::filesystem::path config = std::filesystem::path(FLEETMAP_SOURCE_DIR) / "config";
  auto lidar = config::load_lidar_spec(config / "sensors" / (std::string(how.lidar) + ".yaml"));
  if (!lidar) {
    std::printf("%s\n", lidar.error().message.c_str());
    return 1;
  }
  lidar->range_noise = how.noise;
  *lidar = sim::at_rate(*lidar, how.rate);
  std::vector<std::vector<Result>> all;
  for (std::size_t k = 0; k < sites.size(); ++k) {
    all.push_back(run(*sites[k].world, *sites[k].scene, *lidar, how, length, k + 1));
  }
  for (std::size_t v = 0; v < std::size(kVariants); ++v) {
    Result mean, worst;
    for (const auto& results : all) {
      mean.ate += results[v].ate / static_cast<double>(all.size());
      mean.drift += results[v].drift / static_cast<double>(all.size());
      mean.cpu_ms += results[v].cpu_ms / static_cast<double>(all.size());
      worst.ate = std::max(worst.ate, results[v].ate);
      worst.drift = std::max(worst.drift, results[v].drift);
      worst.lost += results[v].lost;
    }
    std::printf("| %s | %s | %.3f (%.3f) | %.3f (%.3f) | %llu | %.1f |\n", how.name, kVariants[v].name,
                mean.ate, worst.ate, 100.0 * mean.drift, 100.0 * worst.drift,
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
  for (const Condition& how : kConditions) {
    if (!only.empty() && std::string(how.name).find(only) == std::string::npos) continue;
    if (const int failed = print(sites, how, length); failed != 0) return failed;
  }
  return 0;
}
