// Data packets of a Velodyne LiDAR: from a bag's message, or as they come over UDP.
#include <algorithm>

#include "checks.hpp"
#include "fleetmap/core/byte_fields.hpp"
#include "fleetmap/ros_codec/velodyne_scan.hpp"
#include "fleetmap/sensor/velodyne_sweeps.hpp"

namespace fleetmap::fuzz {
namespace {

constexpr float kLongestSweep = 0.31f;  // s

/// Sweeps under the laws that a scan keeps whatever the packets hold.
class Sweeps {
 public:
  void add(ByteView packet, Stamp arrival) {
    const auto added = sweeps_.add(packet, arrival);
    if (!added) require(!added.error().what.empty(), "refused without a reason");
    check();
  }
  void finish() {
    sweeps_.finish();
    check();
  }

 private:
  void check() {
    while (const auto scan = sweeps_.take()) {
      for (const sensor::ScanPoint& point : scan->points) {
        require(point.position.allFinite(), "a point is not finite");
        require(point.time >= 0.0f && point.time < kLongestSweep, "a point is not within its sweep");
        require(point.ring < sensor::VelodyneModel::kMaxLasers, "a ring that no device has");
      }
    }
  }
  sensor::VelodyneSweeps sweeps_;
};

void read_message(ByteView cdr) {
  const MemoryPeak memory;
  const auto scan = ros_codec::decode_velodyne_scan(cdr);
  require(memory.bytes() <= 65'536 + 32 * cdr.size(), "decoding allocates far more than its bytes");
  if (!scan) return require(!scan.error().message.empty(), "refused without a reason");
  require(ros_codec::decode_velodyne_scan(ros_codec::encode(*scan)).has_value(),
          "what was accepted is refused when recorded");
  Sweeps sweeps;
  for (const auto& packet : scan->packets) sweeps.add(packet.data, packet.received);
  sweeps.finish();
}

/// Each packet behind the milliseconds since the one before.
void read_datagrams(ByteView bytes) {
  Sweeps sweeps;
  Stamp arrival = stamp_from_ns(1'700'000'000'000'000'000);
  for (ByteFields fields(bytes); !fields.rest().empty();) {
    arrival += std::chrono::milliseconds(fields.number<std::uint16_t>());
    sweeps.add(fields.take(std::min(fields.rest().size(), sensor::kVelodynePacketBytes)), arrival);
  }
  sweeps.finish();
}

}  // namespace
}  // namespace fleetmap::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap::fuzz;
  const Input input = split(data, size);
  input.choice % 2 == 0 ? read_message(input.rest) : read_datagrams(input.rest);
  return 0;
}
