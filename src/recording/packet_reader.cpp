#include "packet_reader.hpp"

#include <utility>

#include "packet_counters.hpp"

namespace fleetmap::recording {
void PacketReader::add_packet(ByteView packet, Stamp arrival, Stamp recorded) {
  recorded_ = recorded;
  if (const auto added = sweeps_.add(packet, arrival); !added)
    skip(counter_of(added.error().fault), added.error().what);
  count_incomplete();
}

void PacketReader::finish_packets() {
  sweeps_.finish();
  count_incomplete();
}

std::optional<PacketReader::PacketScan> PacketReader::next_scan() {
  while (auto scan = sweeps_.take()) {
    ros_codec::DecodedScan decoded{.scan = std::move(*scan)};
    if (!admit_points(decoded, "a sweep")) continue;
    Sample sample(std::move(decoded.scan));
    if (!admit(sample)) continue;
    sensor::Scan& admitted = std::get<sensor::Scan>(sample);
    if (stamps_only()) admitted.points.clear();
    return PacketScan{std::move(admitted), recorded_};
  }
  return std::nullopt;
}

void PacketReader::count_incomplete() {
  const std::uint64_t more = sweeps_.counters().incomplete_sweeps - counters_.incomplete_sweeps;
  if (more > 0) skip(&Counters::incomplete_sweeps, kIncompleteSweep, more);
}

}  // namespace fleetmap::recording
