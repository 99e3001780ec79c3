#include "oxts.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <numbers>

namespace fleetmap::recording {
namespace {

/// Places in a record, of the 30 that the devkit's dataformat.txt lists.
enum Column : std::size_t {
  kLat = 0,
  kLon = 1,
  kAlt = 2,
  kRoll = 3,
  kPitch = 4,
  kYaw = 5,
  kVf = 8,
  kAx = 11,
  kWx = 17,
  kPosAccuracy = 23,
  kColumns = 30
};

// The RT3003's data sheet: roll and pitch 0.03 deg, heading 0.1 deg.
constexpr double kTiltVariance = 2.7e-7;
constexpr double kHeadingVariance = 3.0e-6;

}  // namespace

Result<OxtsFrame> read_oxts_file(const std::filesystem::path& file, Stamp stamp) {
  std::ifstream stream(file);
  if (!stream) return failure(file.string() + ": cannot be read");
  std::array<double, kColumns> v{};
  for (std::size_t k = 0; k < kColumns; ++k) {
    std::string word;
    stream >> word;
    char* end = nullptr;
    v[k] = std::strtod(word.c_str(), &end);
    if (word.empty() || *end != '\0' || !std::isfinite(v[k])) {
      return failure(file.string() + ": number " + std::to_string(k + 1) + " of 30 is missing or not finite");
    }
  }
  OxtsFrame frame;
  frame.imu.stamp = frame.fix.stamp = frame.wheel.stamp = stamp;
  frame.imu.specific_force = {v[kAx], v[kAx + 1], v[kAx + 2]};
  frame.imu.angular_velocity = {v[kWx], v[kWx + 1], v[kWx + 2]};
  // KITTI's yaw is 0 towards east and grows counter-clockwise: the ENU convention.
  frame.imu.q_enu_imu = Eigen::Quaterniond(rotation_from_rpy(v[kRoll], v[kPitch], v[kYaw]));
  frame.imu.orientation_variance = {kTiltVariance, kTiltVariance, kHeadingVariance};
  frame.fix.position = geo_point_from_degrees(v[kLat], v[kLon], v[kAlt]);
  frame.fix.valid = is_valid(frame.fix.position);
  frame.fix.covariance = v[kPosAccuracy] * v[kPosAccuracy] * Eigen::Matrix3d::Identity();
  frame.wheel.forward_speed = v[kVf];
  frame.wheel.yaw_rate = v[kWx + 2];
  return frame;
}

/// Box and Muller: unlike std::normal_distribution, the same on every standard library.
double FixError::normal() {
  const double u = (static_cast<double>(engine_() >> 11) + 1.0) * 0x1p-53;
  const double v = static_cast<double>(engine_() >> 11) * 0x1p-53;
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
}

sensor::Fix FixError::degraded(const sensor::Fix& fix) {
  // The first error is drawn from the stationary distribution, as after an infinite time.
  // A stamp that goes back adds nothing.
  const double elapsed = last_ ? std::max(0.0, to_seconds(fix.stamp - *last_)) : 0.0;
  const double keep = last_ ? std::exp(-elapsed / config_.correlation_time) : 0.0;
  const double fresh = config_.sigma * std::sqrt(1.0 - keep * keep);
  for (double& error : error_) error = keep * error + fresh * normal();
  last_ = last_ ? std::max(*last_, fix.stamp) : fix.stamp;
  sensor::Fix out = fix;
  if (fix.valid) out.position = LocalFrame(fix.position).to_geo(error_);
  out.covariance = config_.sigma * config_.sigma * Eigen::Matrix3d::Identity();
  return out;
}

}  // namespace fleetmap::recording
