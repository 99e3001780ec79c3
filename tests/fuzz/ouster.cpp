// Packets of an Ouster LiDAR and of its IMU as they come over UDP, and its metadata.
#include <algorithm>
#include <array>
#include <cmath>

#include "checks.hpp"
#include "fleetmap/core/byte_fields.hpp"
#include "fleetmap/sensor/ouster_sensor.hpp"
#include "support/ouster_packets.hpp"

namespace fleetmap::fuzz {
namespace {

constexpr std::array kProfiles{"LEGACY",          "RNG19_RFL8_SIG16_NIR16", "RNG19_RFL8_SIG16_NIR16_DUAL",
                               "RNG15_RFL8_NIR8", "RNG15_RFL8_NIR8_DUAL",   "FUSA_RNG15_RFL8_NIR8_DUAL"};

void read_metadata(ByteView json) {
  const auto metadata = sensor::read_ouster_metadata(text_of(json));
  if (!metadata) return require(!metadata.error().message.empty(), "refused without a reason");
  require(metadata->lidar_packet_bytes() > 0 && metadata->first_column <= metadata->last_column &&
              metadata->last_column < metadata->columns_per_frame,
          "the metadata contradict themselves");
  for (const Eigen::Vector3f& beam : metadata->beams)
    require(std::abs(beam.norm() - 1.0f) < 1e-4f, "a beam is no direction");
  sensor::OusterSensor sensor(*metadata);
  sensor.add_lidar(Bytes(std::min<std::size_t>(metadata->lidar_packet_bytes(), 100'000), 0xff), Stamp());
}

void check(sensor::OusterSensor& sensor) {
  constexpr float kLongest = 0.31f;  // s
  while (const auto scan = sensor.take()) {
    require(scan->points.size() <= sensor.metadata().columns_per_frame * sensor.metadata().beams.size(),
            "more points than a turn has");
    for (const sensor::ScanPoint& point : scan->points) {
      require(point.position.allFinite(), "a point is not finite");
      require(std::abs(point.time) < kLongest, "a point is not within its turn");
      require(point.ring < sensor.metadata().beams.size(), "a ring that the device has not");
    }
  }
}

/// Each packet behind the milliseconds since the one before and its kind.
void read_datagrams(std::size_t profile, ByteView bytes) {
  testing::OusterDevice device(Duration::zero());
  device.profile = kProfiles.at(profile);
  device.columns = 64;
  device.columns_per_packet = 4;
  sensor::OusterSensor sensor(sensor::read_ouster_metadata(device.metadata()).value());
  const std::size_t packet_bytes = sensor.metadata().lidar_packet_bytes();
  Stamp arrival = stamp_from_ns(1'700'000'000'000'000'000);
  for (ByteFields fields(bytes); !fields.rest().empty();) {
    arrival += std::chrono::milliseconds(fields.number<std::uint16_t>());
    const bool is_imu = fields.number<std::uint8_t>() % 2 == 1;
    const ByteView packet =
        fields.take(std::min(fields.rest().size(), is_imu ? sensor::kOusterImuBytes : packet_bytes));
    if (is_imu) {
      const auto imu = sensor.add_imu(packet, arrival);
      require(imu ? imu->specific_force.allFinite() && imu->angular_velocity.allFinite()
                  : !imu.error().what.empty(),
              "a sample is not finite, or refused without a reason");
    } else if (const auto added = sensor.add_lidar(packet, arrival); !added) {
      require(!added.error().what.empty(), "refused without a reason");
    }
    check(sensor);
  }
  sensor.finish();
  check(sensor);
}

}  // namespace
}  // namespace fleetmap::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap::fuzz;
  const Input input = split(data, size);
  const std::size_t choice = input.choice % (kProfiles.size() + 1);
  choice < kProfiles.size() ? read_datagrams(choice, input.rest) : read_metadata(input.rest);
  return 0;
}
