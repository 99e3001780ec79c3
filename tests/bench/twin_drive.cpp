#include "bench/twin_drive.hpp"

#include <cmath>
#include <numbers>

namespace fleetmap::testing {
namespace {

constexpr double kSpeed = 1.0;     // m/s
constexpr double kPeriod = 0.1;    // s, of the commands
constexpr double kStop = 3.0;      // s
constexpr double kTurnRate = 0.8;  // rad/s, of the turn on the spot

/// Lane after lane, each at most half of `length`, joined at their ends.
std::vector<Eigen::Vector2d> serpentine(const sim::World& world, double first_lane, double length) {
  const auto& lanes = world.aisles();
  const auto count = static_cast<double>(lanes.size());
  auto lane = static_cast<std::size_t>(std::floor(first_lane * (count - 1.0)));
  std::vector<Eigen::Vector2d> path;
  double way = 0.0;
  for (bool out = true; way < length && lane < lanes.size(); ++lane, out = !out) {
    const Eigen::Vector2d along = (lanes[lane].to - lanes[lane].from).normalized();
    const double whole = (lanes[lane].to - lanes[lane].from).norm();
    const double part = std::min(whole, 0.5 * length);
    const Eigen::Vector2d end = lanes[lane].to, begin = end - part * along;
    path.push_back(out ? begin : end);
    path.push_back(out ? end : begin);
    way += part;
  }
  return path;
}

}  // namespace

sim::RobotTwinConfig drive_robot(const sim::LidarSpec& lidar, std::uint64_t seed) {
  sim::RobotTwinConfig robot;
  robot.lidar = lidar;
  robot.T_base_lidar = make_pose(rotation_from_rpy(0.0, 0.02, 0.0), {0.1, 0.0, 0.5});
  robot.T_base_imu = make_pose(rotation_from_rpy(0.0, 0.0, 0.5), {0.0, 0.1, 0.1});
  robot.seed = seed;
  return robot;
}

double first_lane_of(std::uint64_t seed) { return 0.2 + 0.1 * static_cast<double>(seed % 5); }

TwinDrive::TwinDrive(std::shared_ptr<const sim::World> world, std::shared_ptr<const sim::Scene> scene,
                     const sim::RobotTwinConfig& robot, double first_lane, double length)
    : world_(std::move(world)), scene_(std::move(scene)), robot_(robot), length_(length) {
  path_ = serpentine(*world_, first_lane, length);
  robot_.start = path_[0];
  const Eigen::Vector2d along = path_[1] - path_[0];
  robot_.start_yaw = std::atan2(along.y(), along.x());
}

bool TwinDrive::run(const Listener& listener) {
  auto made = sim::RobotTwin::create(world_, geo_point_from_degrees(49, 8, 100), robot_, Stamp{});
  if (!made) return false;
  sim::RobotTwin& twin = *made;
  next_ = 1;
  standing_ = turned_ = 0.0;
  const Pose T_lidar_base = robot_.T_base_lidar.inverse();
  for (int k = 0; twin.odometer() < length_ && next_ < path_.size(); ++k) {
    const double seconds = k * kPeriod;
    if (seconds > 3.0 * length_) return false;
    command(twin, seconds);
    for (const sim::TwinSample& sample : twin.advance(Stamp{from_seconds(seconds + kPeriod)})) {
      if (const auto* imu = std::get_if<sensor::Imu>(&sample)) listener.imu(*imu);
      if (const auto* wheel = std::get_if<sensor::Wheel>(&sample)) listener.wheel(*wheel);
      const auto* job = std::get_if<sim::ScanJob>(&sample);
      if (job == nullptr) continue;
      listener.scan(cast_scan(*scene_, robot_.lidar, *job), job->T_enu_lidar.front() * T_lidar_base);
    }
  }
  return true;
}

/// Straight for the next corner of the path; corners are turned on the spot.
void TwinDrive::command(sim::RobotTwin& twin, double seconds) {
  if (seconds < 1.0) return twin.command(0.0, 0.0);
  if (twin.odometer() > 0.25 * length_ && standing_ < kStop) {
    standing_ += kPeriod;
    return twin.command(0.0, 0.0);
  }
  if (twin.odometer() > 0.75 * length_ && turned_ < 2.0 * std::numbers::pi) {
    turned_ += kPeriod * kTurnRate;
    return twin.command(0.0, kTurnRate);
  }
  const Pose T = twin.T_enu_base();
  const Eigen::Vector2d p = T.translation().head<2>();
  while (next_ + 1 < path_.size() && (path_[next_] - p).norm() < 0.3) ++next_;
  if (next_ + 1 == path_.size() && (path_[next_] - p).norm() < 0.3) {
    ++next_;
    return;
  }
  // Towards a place some metres ahead on the line, so that it comes back to the line.
  const Eigen::Vector2d line = (path_[next_] - path_[next_ - 1]).normalized();
  const double left = line.dot(path_[next_] - p);
  const Eigen::Vector2d aim = path_[next_] - std::max(0.0, left - 2.0) * line;
  const double error =
      wrap_angle(std::atan2(aim.y() - p.y(), aim.x() - p.x()) - rpy_from_rotation(T.linear()).z());
  const bool on_the_spot = std::abs(error) > 0.5;
  twin.command(on_the_spot ? 0.0 : kSpeed, std::clamp(1.5 * error, -0.8, 0.8));
}

}  // namespace fleetmap::testing
