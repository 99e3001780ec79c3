#include "sim/lane_odometry.hpp"

#include <algorithm>
#include <random>

#include "fleetmap/core/cpu_time.hpp"
#include "fleetmap/odometry/loam.hpp"
#include "odometry/trajectory_error.hpp"

namespace fleetmap::testing {
namespace {

struct Run {
  odometry::Loam loam;
  bool gyro;
  std::vector<Pose> estimate;
  double cpu = 0.0;  ///< s
};

std::vector<Run> runs_of(const sim::LidarSpec& lidar, const DriveCondition& how,
                         std::span<const OdometryUse> uses) {
  odometry::LoamConfig config;
  config.T_base_lidar = T_base_mast();
  config.range_noise = std::max(0.02, how.noise);
  std::vector<Run> runs;
  for (const OdometryUse& use : uses) {
    config.deskew = use.deskew;
    runs.push_back({odometry::Loam(config, *odometry::lidar_model(lidar.model)), use.gyro, {}, 0.0});
  }
  return runs;
}

/// A gyro with a bias of some mrad/s.
class Gyro {
 public:
  Gyro(const LaneDrive& drive, std::uint64_t seed) : drive_(drive), random_(seed) {}
  sensor::Imu at(double seconds) {
    const auto step = static_cast<std::size_t>(seconds / LaneDrive::kStep);
    sensor::Imu imu;
    imu.stamp = Stamp{from_seconds(seconds)};
    imu.angular_velocity = so3_log(drive_.base(step).linear().transpose() * drive_.base(step + 5).linear()) /
                               (5 * LaneDrive::kStep) +
                           Eigen::Vector3d(0.003, -0.002, 0.004) +
                           0.003 * Eigen::Vector3d(normal_(random_), normal_(random_), normal_(random_));
    return imu;
  }

 private:
  const LaneDrive& drive_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

}  // namespace

Pose T_base_mast() { return make_pose(rotation_from_rpy(0.0, 0.02, 0.0), {0.1, 0.0, 0.6}); }

sim::ScanJob scan_of(const LaneDrive& drive, const sim::LidarSpec& lidar, std::uint64_t number,
                     std::uint64_t seed) {
  const double period = 1.0 / lidar.rate, begin = period * static_cast<double>(number);
  const auto first = static_cast<std::size_t>(begin / LaneDrive::kStep);
  sim::ScanJob job{Stamp{from_seconds(begin)}, from_seconds(LaneDrive::kStep), {}, number, seed};
  for (std::size_t step = 0; static_cast<double>(step) * LaneDrive::kStep <= period + LaneDrive::kStep;
       ++step) {
    job.T_enu_lidar.push_back(drive.base(first + step) * drive.shaken(first + step) * T_base_mast());
  }
  return job;
}

std::vector<LaneOdometry> odometry_of_lanes(const sim::World& world, const sim::Scene& scene,
                                            const sim::LidarSpec& lidar, const DriveCondition& how,
                                            double length, std::uint64_t seed,
                                            std::span<const OdometryUse> uses) {
  const LaneDrive drive(world, how, length, seed);
  std::vector<Run> runs = runs_of(lidar, how, uses);
  Gyro gyro(drive, seed);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Pose> truth;
  const double period = 1.0 / lidar.rate;
  double fed = 0.0;
  for (std::uint64_t k = 0; period * static_cast<double>(k + 1) < drive.duration(); ++k) {
    const double begin = period * static_cast<double>(k);
    for (; fed < begin + period + 0.02; fed += 0.01) {
      const sensor::Imu imu = gyro.at(fed);
      for (Run& run : runs) {
        if (run.gyro) run.loam.add_imu(imu);
      }
    }
    if (k % static_cast<std::uint64_t>(how.every) != 0) continue;
    sensor::Scan scan = sim::cast_scan(scene, lidar, scan_of(drive, lidar, k, seed));
    if (how.keep < 1.0) std::erase_if(scan.points, [&](const auto&) { return uniform(random) > how.keep; });
    truth.push_back(drive.base(static_cast<std::size_t>(begin / LaneDrive::kStep)));
    for (Run& run : runs) {
      const double before = thread_cpu_seconds();
      const auto update = run.loam.add_scan(scan);
      run.cpu += thread_cpu_seconds() - before;
      run.estimate.push_back(update ? update->T_odom_base : run.estimate.back());
    }
  }
  std::vector<LaneOdometry> results;
  for (const Run& run : runs) {
    const odometry::LoamCounters& counters = run.loam.counters();
    results.push_back({aligned_rmse(run.estimate, truth), relative_drift(run.estimate, truth, 20.0),
                       1e3 * run.cpu / static_cast<double>(truth.size()), truth.size(), counters.lost,
                       counters.map_restarts});
  }
  return results;
}

}  // namespace fleetmap::testing
