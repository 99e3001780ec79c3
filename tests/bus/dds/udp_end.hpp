#pragma once

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <string>

#include "bus/dds/hello.hpp"
#include "bus/dds/rtps_header.hpp"

namespace fleetmap::bus::testing {

/// A UDP socket at a port of this machine.
class UdpEnd {
 public:
  explicit UdpEnd(std::uint16_t port) {
    sockaddr_in here{};
    here.sin_family = AF_INET;
    here.sin_port = htons(port);
    here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (bind(fd_, reinterpret_cast<const sockaddr*>(&here), sizeof here) != 0)
      throw std::runtime_error("port " + std::to_string(port) + " is taken");
  }
  ~UdpEnd() { close(fd_); }
  UdpEnd(const UdpEnd&) = delete;
  UdpEnd& operator=(const UdpEnd&) = delete;
  /// The next datagram that waits, if any.
  std::optional<Bytes> datagram() {
    pollfd waits{fd_, POLLIN, 0};
    if (poll(&waits, 1, 0) != 1) return std::nullopt;
    Bytes bytes(65536);
    bytes.resize(static_cast<std::size_t>(std::max<ssize_t>(recv(fd_, bytes.data(), bytes.size(), 0), 0)));
    return bytes;
  }
  /// The next Hello that waits, if any.
  std::optional<Hello> hello() {
    while (const auto bytes = datagram()) {
      if (const auto cdr = hello_in(*bytes)) {
        std::copy_n(bytes->begin() + 8, from.size(), from.begin());
        return decode_hello(*cdr);
      }
    }
    return std::nullopt;
  }

  std::array<std::uint8_t, 12> from{};  ///< prefix of the sender of the last Hello

 private:
  int fd_ = socket(AF_INET, SOCK_DGRAM, 0);
};

}  // namespace fleetmap::bus::testing
