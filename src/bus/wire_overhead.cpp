#include "fleetmap/bus/wire_overhead.hpp"

#include <algorithm>

namespace fleetmap::bus {

std::size_t datagrams(std::size_t payload, const WireOverhead& overhead) {
  return std::max<std::size_t>(1,
                               (payload + overhead.max_datagram_payload - 1) / overhead.max_datagram_payload);
}

std::size_t wire_bytes(std::size_t payload, const WireOverhead& overhead) {
  return payload + datagrams(payload, overhead) * (overhead.ip_udp + overhead.rtps + overhead.seal);
}

}  // namespace fleetmap::bus
