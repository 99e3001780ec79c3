#include "fleetmap/sensor/turn_direction.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fleetmap::sensor {
namespace {

constexpr double kComparedTurn = 0.1, kTurnNeeded = 1.0;  // rad
constexpr int kScansNeeded = 5;
constexpr Duration kMaxAge = std::chrono::milliseconds(1500);
constexpr double kFitsBetter = 0.7;                // misfit against the gyro over that with it
constexpr float kLowest = -0.4f, kHighest = 3.0f;  // m about the LiDAR: neither ground nor roofs
constexpr float kNearestThing = 1.0f, kFarthestThing = 60.0f;
constexpr double kMaxMisfit = 0.3;  // logarithm of ranges: another thing

}  // namespace

void TurnDirection::add(const Imu& imu) { gyro_.add(imu.stamp, q_base_imu_ * imu.angular_velocity); }

void TurnDirection::add(const Wheel& wheel) {
  if (wheel.yaw_rate) wheels_.add(wheel.stamp, {0.0, 0.0, *wheel.yaw_rate});
}

void TurnDirection::add(const Scan& scan) {
  if (decided_ || !gyro_.last()) return;
  const auto turned = reference_ ? gyro_.between(reference_->stamp, scan.stamp) : std::nullopt;
  const bool is_recent =
      reference_ && scan.stamp >= reference_->stamp && scan.stamp - reference_->stamp < kMaxAge;
  if (is_recent && (!turned || std::abs(turned->z()) <= kComparedTurn)) return;
  const Ranges now = ranges_of(scan);
  if (is_recent) {
    compare(now, turned->z());
    if (const auto wheels = wheels_.between(reference_->stamp, scan.stamp))
      with_wheels_ += turned->z() * wheels->z();
  }
  reference_ = {scan.stamp, now};
  decided_ = turned_ >= kTurnNeeded && compared_ >= kScansNeeded;
}

TurnDirection::Ranges TurnDirection::ranges_of(const Scan& scan) const {
  Ranges ranges{};
  for (const ScanPoint& point : scan.points) {
    const Eigen::Vector3f p = R_base_lidar_ * point.position;
    const float range = p.head<2>().norm();
    if (!(range > kNearestThing && range < kFarthestThing && p.z() > kLowest && p.z() < kHighest)) continue;
    const double azimuth = 0.5 + 0.5 * static_cast<double>(std::atan2(p.y(), p.x())) / std::numbers::pi;
    float& nearest = ranges.at(static_cast<std::size_t>(azimuth * static_cast<double>(kBins)) % kBins);
    if (nearest == 0.0f || range < nearest) nearest = range;
  }
  return ranges;
}

void TurnDirection::compare(const Ranges& now, double turned) {
  const auto bins = static_cast<std::ptrdiff_t>(kBins);
  const auto shift = std::lround(turned / (2.0 * std::numbers::pi) * static_cast<double>(kBins));
  const auto misfit = [&](std::ptrdiff_t by) {
    double sum = 0.0, count = 1e-9;
    for (std::ptrdiff_t k = 0; k < bins; ++k) {
      const float before = reference_->ranges.at(static_cast<std::size_t>(k));
      const float after = now.at(static_cast<std::size_t>(((k - by) % bins + bins) % bins));
      if (before == 0.0f || after == 0.0f) continue;
      sum += std::min(kMaxMisfit, std::abs(std::log(static_cast<double>(after / before))));
      count += 1.0;
    }
    return sum / count;
  };
  ++compared_;
  turned_ += std::abs(turned);
  along_ += misfit(shift);
  against_ += misfit(-shift);
  unturned_ += misfit(0);
}

std::optional<std::string> TurnDirection::finding() const {
  // A gyro of another unit, whose turns fit neither way, fits best without a turn.
  if (!decided_ || against_ > kFitsBetter * along_ || against_ > unturned_) return std::nullopt;
  const std::string mirrored =
      "its points are mirrored (left-handed axes, or a device that turns the other way), or it is mounted "
      "upside down and lidar.rotation_rpy_deg does not say so";
  // The first two as MotionAgreement states them.
  if (with_wheels_ > 0.0) return "LiDAR: it turns right where gyro and wheels turn left: " + mirrored;
  if (with_wheels_ < 0.0)
    return "IMU: its gyro turns right where LiDAR and wheels turn left: the sign of its z axis is wrong, or "
           "the IMU is upside down. Correct the driver, or state the IMU's mount (imu.rotation_rpy_deg)";
  return "LiDAR: it turns right where the gyro turns left: " + mirrored +
         "; or the sign of the gyro's z axis is wrong, or the IMU is upside down and imu.rotation_rpy_deg "
         "does not say so";
}

}  // namespace fleetmap::sensor
