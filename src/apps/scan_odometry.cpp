#include "scan_odometry.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

#include "fleetmap/core/cpu_time.hpp"

namespace fleetmap::apps {

std::vector<std::string> OdometryRun::failures(std::size_t scans) const {
  std::vector<std::string> failures;
  if (!kept_its_way()) failures.emplace_back("odometry: it lost its way; see the findings before this");
  if (poses.empty() && scans > 0) failures.push_back("odometry: no scan could be used: " + first_refusal);
  return failures;
}

ScanOdometry::ScanOdometry(const agent::PerceptionConfig& config)
    : uses_imu_(config.odometry_uses_imu),
      uses_wheel_(config.odometry_uses_wheel),
      loam_(config.odometry, config.lidar),
      turns_(config.odometry.T_base_lidar.linear(), config.odometry.q_base_imu) {}

void ScanOdometry::set_imu_rotation(const Eigen::Quaterniond& q_base_imu) {
  loam_.set_imu_rotation(q_base_imu);
  turns_.set_imu_rotation(q_base_imu);
}

std::optional<odometry::OdometryUpdate> ScanOdometry::add(const SweepInput& input) {
  check_turns(input);
  if (uses_imu_) {
    for (const sensor::Imu& imu : input.imu) loam_.add_imu(imu);
  }
  if (uses_wheel_) {
    for (const sensor::Wheel& wheel : input.wheels) loam_.add_wheel(wheel);
  }
  auto update = timed(input.scan);
  std::ranges::move(loam_.take_warnings(), std::back_inserter(findings_));
  run_.counters = loam_.counters();
  if (const odometry::LocalMapSize map = loam_.map_size(); map.bytes > run_.map.bytes) run_.map = map;
  if (!update) {
    if (run_.refused++ == 0) run_.first_refusal = update.error().message;
    return std::nullopt;
  }
  run_.poses.push_back({update->stamp, update->T_odom_base});
  run_.way.add(*update);
  run_.blind += update->degenerate_count > 0;
  if (update->lost && !run_.first_lost) run_.first_lost = update->stamp;
  return std::move(*update);
}

Result<odometry::OdometryUpdate> ScanOdometry::timed(const sensor::Scan& scan) {
  const double cpu = thread_cpu_seconds();
  const auto start = std::chrono::steady_clock::now();
  auto update = loam_.add_scan(scan);
  run_.wall_ms.push_back(
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  run_.cpu_s += thread_cpu_seconds() - cpu;
  return update;
}

void ScanOdometry::check_turns(const SweepInput& input) {
  if (turns_.decided()) return;
  for (const sensor::Imu& imu : input.imu) turns_.add(imu);
  for (const sensor::Wheel& wheel : input.wheels) turns_.add(wheel);
  turns_.add(input.scan);
  if (auto finding = turns_.finding()) findings_.push_back(std::move(*finding));
}

std::vector<std::string> ScanOdometry::take_findings() { return std::exchange(findings_, {}); }

}  // namespace fleetmap::apps
