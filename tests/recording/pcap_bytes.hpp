#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/time.hpp"

/// A capture, written by the format's specification.
namespace fleetmap::recording::testing {

struct PcapFormat {
  bool big_endian = false, nanoseconds = false;
};

inline std::string number(std::uint64_t value, std::size_t bytes, bool big_endian) {
  std::string text;
  for (std::size_t k = 0; k < bytes; ++k) text.push_back(static_cast<char>(value >> (8 * k)));
  if (big_endian) std::reverse(text.begin(), text.end());
  return text;
}

inline std::string pcap_header(const PcapFormat& format = {}, std::uint32_t link = 1) {
  const bool big = format.big_endian;
  return number(format.nanoseconds ? 0xa1b23c4d : 0xa1b2c3d4, 4, big) + number(2, 2, big) +
         number(4, 2, big) + std::string(8, '\0') + number(262'144, 4, big) + number(link, 4, big);
}

inline std::string pcap_record(Stamp captured, const std::string& frame, const PcapFormat& format = {}) {
  const bool big = format.big_endian;
  const auto ns = static_cast<std::uint64_t>(to_ns(captured));
  const std::uint64_t fraction = ns % 1'000'000'000 / (format.nanoseconds ? 1 : 1'000);
  return number(ns / 1'000'000'000, 4, big) + number(fraction, 4, big) + number(frame.size(), 4, big) +
         number(frame.size(), 4, big) + frame;
}

struct UdpFrame {
  std::uint32_t source = 0xc0a801c9;  ///< 192.168.1.201, as a Velodyne LiDAR is delivered
  std::uint16_t port = 2368;
  std::string tags{};        ///< VLAN tags
  std::string ip_options{};  ///< of 4, 8, ... bytes
  std::uint16_t fragment = 0;
  std::uint8_t protocol = 17;
};

inline std::string ip_frame(const UdpFrame& frame, const std::string& data) {
  const std::size_t header = 20 + frame.ip_options.size();
  std::string ip = number(0x40 + header / 4, 1, true) + number(0, 1, true) +
                   number(header + data.size(), 2, true) + number(1, 2, true) +
                   number(frame.fragment, 2, true) + number(64, 1, true) + number(frame.protocol, 1, true) +
                   number(0, 2, true) + number(frame.source, 4, true) + number(0xffffffff, 4, true) +
                   frame.ip_options;
  return std::string(12, '\x11') + frame.tags + number(0x0800, 2, true) + ip + data;
}

inline std::string udp_datagram(const UdpFrame& frame, const Bytes& payload) {
  return number(50'000, 2, true) + number(frame.port, 2, true) + number(payload.size() + 8, 2, true) +
         number(0, 2, true) + std::string(payload.begin(), payload.end());
}

inline std::string udp_frame(const UdpFrame& frame, const Bytes& payload) {
  return ip_frame(frame, udp_datagram(frame, payload));
}

/// In frames of at most 1500 bytes of IPv4.
inline std::vector<std::string> udp_fragments(UdpFrame frame, const Bytes& payload) {
  constexpr std::size_t kPart = 1480;
  constexpr std::uint16_t kMoreFollow = 0x2000;
  const std::string datagram = udp_datagram(frame, payload);
  std::vector<std::string> frames;
  for (std::size_t at = 0; at < datagram.size(); at += kPart) {
    frame.fragment = static_cast<std::uint16_t>(at / 8 | (at + kPart < datagram.size() ? kMoreFollow : 0));
    frames.push_back(ip_frame(frame, datagram.substr(at, kPart)));
  }
  return frames;
}

}  // namespace fleetmap::recording::testing
