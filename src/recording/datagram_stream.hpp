#pragma once

#include <cstdint>
#include <string>

#include "pcap_file.hpp"

namespace fleetmap::recording {

/// Source and destination of the packets of a device.
struct DatagramStream {
  std::uint32_t source = 0;
  std::uint16_t port = 0;
  bool operator==(const DatagramStream&) const = default;
};

DatagramStream stream_of(const Datagram& datagram);
/// "192.168.1.201 to port 2368"
std::string to_string(const DatagramStream& stream);

}  // namespace fleetmap::recording
