#include "fleetmap/sensor/mavlink_messages.hpp"

#include <bit>
#include <chrono>

#include "fleetmap/core/byte_fields.hpp"
#include "standard_gravity.hpp"

namespace fleetmap::sensor {
namespace {

constexpr std::uint64_t kFirstUnixTime = 1'000'000'000'000'000;  // us: 2001; nothing runs for so long
constexpr std::uint64_t kLastUnixTime = 4'102'444'800'000'000;   // us: 2100
constexpr std::size_t kMaxPayload = 64;                          // bytes of the types below

/// Fields in the order in which they are sent; those that v2 left out are zero.
class Fields {
 public:
  explicit Fields(ByteView payload)
      : bytes_(payload.begin(), payload.end()), fields_((bytes_.resize(255), bytes_)) {}
  template <class T>
  T next() {
    if constexpr (std::is_same_v<T, float>) {
      return std::bit_cast<float>(fields_.number<std::uint32_t>());
    } else {
      return static_cast<T>(fields_.number<std::make_unsigned_t<T>>());
    }
  }
  template <class T>
  Eigen::Vector3d vector() {
    const double x = next<T>(), y = next<T>(), z = next<T>();
    return {x, y, z};
  }

 private:
  Bytes bytes_;
  ByteFields fields_;
};

std::optional<MavlinkTime> time_of(std::uint64_t microseconds) {
  if (microseconds > kLastUnixTime) return std::nullopt;
  return MavlinkTime{std::chrono::microseconds(microseconds), microseconds >= kFirstUnixTime};
}

std::optional<MavlinkMessage> system_time(Fields fields) {
  const auto unix_time = time_of(fields.next<std::uint64_t>());
  MavlinkSystemTime message;
  if (unix_time && unix_time->is_unix) message.unix_time = unix_time->since;
  message.boot = std::chrono::milliseconds(fields.next<std::uint32_t>());
  return message;
}

std::optional<MavlinkMessage> gps_raw_int(Fields fields) {
  constexpr double kDegrees = 1e-7, kMillimetre = 1e-3;
  const auto time = time_of(fields.next<std::uint64_t>());
  if (!time) return std::nullopt;
  MavlinkGps message{.time = *time};
  const double latitude = fields.next<std::int32_t>() * kDegrees;
  const double longitude = fields.next<std::int32_t>() * kDegrees;
  const double above_sea = fields.next<std::int32_t>() * kMillimetre;
  for (int skipped = 0; skipped < 4; ++skipped) fields.next<std::uint16_t>();  // eph, epv, vel, cog
  message.fix_type = fields.next<std::uint8_t>();
  fields.next<std::uint8_t>();  // satellites
  const double above_ellipsoid = fields.next<std::int32_t>() * kMillimetre;
  message.has_ellipsoid = above_ellipsoid != 0.0;
  message.position =
      geo_point_from_degrees(latitude, longitude, message.has_ellipsoid ? above_ellipsoid : above_sea);
  message.sigma_h = fields.next<std::uint32_t>() * kMillimetre;
  message.sigma_v = fields.next<std::uint32_t>() * kMillimetre;
  return message;
}

std::optional<MavlinkMessage> scaled_imu(Fields fields) {
  constexpr double kMilli = 1e-3;
  MavlinkImu message{.time = {.since = std::chrono::milliseconds(fields.next<std::uint32_t>())}};
  message.specific_force = kStandardGravity * kMilli * fields.vector<std::int16_t>();
  message.angular_velocity = kMilli * fields.vector<std::int16_t>();
  return message;
}

std::optional<MavlinkMessage> attitude_quaternion(Fields fields) {
  MavlinkAttitude message{.boot = std::chrono::milliseconds(fields.next<std::uint32_t>())};
  const double w = fields.next<float>();
  const Eigen::Vector3d axis = fields.vector<float>();
  message.q_ned_frd = Eigen::Quaterniond(w, axis.x(), axis.y(), axis.z());
  const double norm = message.q_ned_frd.norm();
  if (!(norm > 0.9 && norm < 1.1)) return std::nullopt;  // one that is not set is all zeros
  message.q_ned_frd.normalize();
  return message;
}

std::optional<MavlinkMessage> highres_imu(Fields fields) {
  constexpr unsigned kInertial = 0x3f;  // HIGHRES_IMU_UPDATED_FLAGS: accelerations, angular velocities
  const auto time = time_of(fields.next<std::uint64_t>());
  if (!time) return std::nullopt;
  MavlinkImu message{.time = *time, .high_resolution = true};
  message.specific_force = fields.vector<float>();
  message.angular_velocity = fields.vector<float>();
  for (int skipped = 0; skipped < 7; ++skipped) fields.next<float>();  // magnetometer, pressures, temperature
  const auto updated = fields.next<std::uint16_t>();
  const auto instance = fields.next<std::uint8_t>();
  if (instance != 0 || (updated & kInertial) != kInertial) return std::nullopt;
  if (!message.specific_force.allFinite() || !message.angular_velocity.allFinite()) return std::nullopt;
  return message;
}

std::optional<MavlinkMessage> timesync(Fields fields) {
  const auto device = Duration(fields.next<std::int64_t>());
  const auto asked = Duration(fields.next<std::int64_t>());
  constexpr Duration kLatest = std::chrono::microseconds(kFirstUnixTime),
                     kLatestHere = std::chrono::microseconds(kLastUnixTime);
  if (device < Duration::zero() || device > kLatest || asked < Duration::zero() || asked > kLatestHere)
    return std::nullopt;
  return MavlinkTimesync{device, asked};
}

}  // namespace

std::optional<MavlinkMessage> decode_mavlink(const MavlinkFrame& frame) {
  switch (frame.id) {
    case kMavlinkSystemTime:
      return system_time(Fields(frame.payload));
    case kMavlinkGpsRawInt:
      return gps_raw_int(Fields(frame.payload));
    case kMavlinkScaledImu:
      return scaled_imu(Fields(frame.payload));
    case kMavlinkAttitudeQuaternion:
      return attitude_quaternion(Fields(frame.payload));
    case kMavlinkHighresImu:
      return highres_imu(Fields(frame.payload));
    case kMavlinkTimesync:
      return timesync(Fields(frame.payload));
    default:
      return std::nullopt;
  }
}

Bytes encode_mavlink(const MavlinkTimesync& message, std::uint8_t sequence) {
  Bytes payload;
  for (const Duration time : {message.device, message.asked}) {
    for (int shift = 0; shift < 64; shift += 8)
      payload.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(time.count()) >> shift));
  }
  return mavlink_frame(kMavlinkTimesync, payload, sequence);
}

}  // namespace fleetmap::sensor
