#include "fleetmap/sensor/ouster_packet.hpp"

#include <bit>
#include <cmath>
#include <numbers>
#include <string>

#include "fleetmap/core/byte_fields.hpp"
#include "fleetmap/geometry/degree.hpp"
#include "standard_gravity.hpp"

namespace fleetmap::sensor {
namespace {

constexpr std::size_t kFrameAt = 2, kWideFrameAt = 4;

template <class T>
T field_at(ByteView bytes, std::size_t at) {
  return ByteFields(bytes.subspan(at)).number<T>();
}

struct ColumnHeader {
  std::uint64_t time = 0;
  std::uint16_t measurement = 0, legacy_frame = 0;
  bool measured = false;
};

ColumnHeader header_of(ByteView column, const OusterProfile& profile) {
  ByteFields fields(column);
  ColumnHeader header;
  header.time = fields.number<std::uint64_t>();
  header.measurement = fields.number<std::uint16_t>();
  if (profile.is_legacy()) {
    header.legacy_frame = fields.number<std::uint16_t>();
    header.measured = field_at<std::uint32_t>(column, column.size() - profile.column_footer) == 0xffffffff;
  } else {
    header.measured = (fields.number<std::uint16_t>() & 1) != 0;
  }
  return header;
}

}  // namespace

tl::expected<OusterPacket, PacketRefusal> read_ouster_packet(ByteView bytes, const OusterMetadata& metadata) {
  const OusterProfile& profile = metadata.profile;
  if (bytes.size() != metadata.lidar_packet_bytes())
    return refused_packet(PacketFault::kSize, "a packet of " + std::to_string(bytes.size()) + " bytes, not " +
                                                  std::to_string(metadata.lidar_packet_bytes()) +
                                                  " as the metadata of " + metadata.device + " has it (" +
                                                  std::string(profile.name) + ")");
  OusterPacket packet;
  if (profile.wide_frame_id) packet.frame = field_at<std::uint32_t>(bytes, kWideFrameAt);
  if (!profile.wide_frame_id && !profile.is_legacy()) packet.frame = field_at<std::uint16_t>(bytes, kFrameAt);
  const std::size_t column_bytes = profile.column_bytes(metadata.beams.size());
  for (std::size_t k = 0; k < metadata.columns_per_packet; ++k) {
    const ByteView column = bytes.subspan(profile.packet_header + k * column_bytes, column_bytes);
    const ColumnHeader header = header_of(column, profile);
    if (!header.measured) continue;
    if (header.measurement >= metadata.columns_per_frame)
      return refused_packet(PacketFault::kBlock, "column " + std::to_string(header.measurement) +
                                                     " of a turn of " +
                                                     std::to_string(metadata.columns_per_frame));
    if (profile.is_legacy() && packet.columns.empty()) packet.frame = header.legacy_frame;
    if (profile.is_legacy() && packet.frame != header.legacy_frame)
      return refused_packet(PacketFault::kBlock, "columns of turns " + std::to_string(packet.frame) +
                                                     " and " + std::to_string(header.legacy_frame));
    packet.columns.push_back({header.time, header.measurement,
                              column.subspan(profile.column_header, metadata.beams.size() * profile.pixel)});
  }
  return packet;
}

void append_points(const OusterMetadata& metadata, const OusterColumn& column, double time,
                   std::vector<ScanPoint>& points) {
  constexpr float kMetresPerMillimetre = 1e-3f;
  // The device turns clockwise, so that its encoder falls from a full turn at column 0.
  const double encoder = -2.0 * std::numbers::pi * static_cast<double>(column.measurement) /
                         static_cast<double>(metadata.columns_per_frame);
  const Eigen::Matrix3f R_sensor_beams =
      (metadata.T_sensor_lidar.linear() *
       Eigen::AngleAxisd(encoder, Eigen::Vector3d::UnitZ()).toRotationMatrix())
          .cast<float>();
  const Eigen::Vector3f origin =
      R_sensor_beams * metadata.beam_origin + metadata.T_sensor_lidar.translation().cast<float>();
  const float before_origin = metadata.beam_origin.norm();  // ranges contain the way to the beam's origin
  for (std::size_t k = 0; k < metadata.beams.size(); ++k) {
    const OusterReturn one = metadata.profile.last_return(
        column.pixels.subspan(k * metadata.profile.pixel, metadata.profile.pixel));
    const float along = static_cast<float>(one.range) * kMetresPerMillimetre - before_origin;
    if (one.range == 0 || along <= 0.0f) continue;
    ScanPoint& point = points.emplace_back();
    point.position = R_sensor_beams * (along * metadata.beams[k]) + origin;
    point.intensity = one.reflectivity;
    point.time = static_cast<float>(time);
    point.ring = static_cast<std::uint16_t>(k);
  }
}

tl::expected<OusterImu, PacketRefusal> read_ouster_imu(ByteView bytes, const OusterMetadata& metadata) {
  if (bytes.size() != kOusterImuBytes)
    return refused_packet(PacketFault::kSize, "an IMU packet of " + std::to_string(bytes.size()) +
                                                  " bytes, not 48; set udp_profile_imu to LEGACY");
  ByteFields fields(bytes);
  for (int other = 0; other < 2; ++other)
    fields.number<std::uint64_t>();  // of the system and the accelerometer
  OusterImu imu;
  imu.time = fields.number<std::uint64_t>();
  const auto vector = [&] {
    Eigen::Vector3d values;
    for (double& value : values)
      value = static_cast<double>(std::bit_cast<float>(fields.number<std::uint32_t>()));
    return values;
  };
  const Eigen::Matrix3d R_sensor_imu = metadata.T_sensor_imu.linear();
  imu.sample.specific_force = R_sensor_imu * vector() * kStandardGravity;
  imu.sample.angular_velocity = R_sensor_imu * vector() * kDegree;
  if (!imu.sample.specific_force.allFinite() || !imu.sample.angular_velocity.allFinite())
    return refused_packet(PacketFault::kBlock, "an IMU packet with a value that is not finite");
  return imu;
}

}  // namespace fleetmap::sensor
