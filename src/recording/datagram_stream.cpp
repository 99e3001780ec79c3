#include "datagram_stream.hpp"

namespace fleetmap::recording {

DatagramStream stream_of(const Datagram& datagram) { return {datagram.source, datagram.port}; }

std::string to_string(const DatagramStream& stream) {
  std::string text;
  for (int shift = 24; shift >= 0; shift -= 8)
    text += std::to_string(stream.source >> shift & 0xff) + (shift > 0 ? "." : "");
  return text + " to port " + std::to_string(stream.port);
}

}  // namespace fleetmap::recording
