// Bytes that an autopilot sends over a serial line or UDP.
#include <algorithm>

#include "checks.hpp"
#include "fleetmap/sensor/mavlink_sensors.hpp"

namespace fleetmap::fuzz {
namespace {

constexpr Stamp kArrival = stamp_from_ns(1'795'630'000'000'000'000);

struct Counted {
  std::size_t imu = 0, fixes = 0;
  std::uint64_t frames = 0, skipped = 0;
  bool operator==(const Counted&) const = default;
};

/// In pieces of `size`, one a millisecond.
Counted read(ByteView bytes, std::size_t size) {
  sensor::MavlinkSensors sensors;
  Counted counted;
  for (Stamp arrival = kArrival; !bytes.empty(); arrival += std::chrono::milliseconds(1)) {
    const ByteView piece = bytes.first(std::min(size, bytes.size()));
    bytes = bytes.subspan(piece.size());
    const sensor::DeviceSamples samples = sensors.add(piece, arrival);
    for (const sensor::Imu& imu : samples.imu) {
      require(imu.specific_force.allFinite() && imu.angular_velocity.allFinite(),
              "an IMU sample is not finite");
      require(!imu.q_enu_imu || std::abs(imu.q_enu_imu->norm() - 1.0) < 1e-6, "an orientation is none");
    }
    for (const sensor::Fix& fix : samples.fixes) {
      require(!fix.valid || is_valid(fix.position), "a valid fix is not on Earth");
      require(fix.covariance.allFinite(), "a covariance is not finite");
    }
    counted.imu += samples.imu.size();
    counted.fixes += samples.fixes.size();
  }
  counted.frames = sensors.counters().frames.frames;
  counted.skipped = sensors.counters().frames.skipped_bytes;
  return counted;
}

}  // namespace
}  // namespace fleetmap::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap::fuzz;
  const fleetmap::ByteView bytes(data, size);
  const Counted whole = read(bytes, size), pieces = read(bytes, 7);
  require(whole.frames == pieces.frames, "a frame depends on the pieces in which it came");
  require(whole.skipped == pieces.skipped, "skipped bytes depend on the pieces in which they came");
  return 0;
}
