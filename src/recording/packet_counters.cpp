#include "packet_counters.hpp"

namespace fleetmap::recording {

std::uint64_t Counters::*counter_of(sensor::PacketFault fault) {
  switch (fault) {
    case sensor::PacketFault::kSize:
      return &Counters::packets_of_wrong_size;
    case sensor::PacketFault::kBlock:
      return &Counters::packets_of_wrong_blocks;
    default:
      return &Counters::packets_of_unknown_device;
  }
}

}  // namespace fleetmap::recording
