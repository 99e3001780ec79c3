#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "bus/captured_log.hpp"
#include "bus/dds/hello.hpp"
#include "bus/dds_domains.hpp"
#include "bus/fleet.hpp"
#include "fleetmap/bus/dds_bus.hpp"

namespace fleetmap::bus::testing {

inline constexpr FleetSettings kSettings{
    .wire_schema = 3, .fleet = 0x12345678, .submap_voxel = 1000, .map_voxel = 1000, .placement = 7};

inline AgentId name(const char* text) { return AgentId::parse(text).value(); }

class LoneRadio : public ::testing::Test {
 protected:
  /// On the long range of this machine alone.
  static DdsBusConfig robot(const char* id, const std::optional<FleetSettings>& settings = kSettings) {
    DdsBusConfig config;
    config.agent = name(id);
    config.qos_directory = FLEETMAP_SOURCE_DIR "/qos";
    config.onboard.enabled = false;
    config.short_range.enabled = false;
    config.long_range.domain = first_test_domain();
    config.long_range.address = "127.0.0.1";
    config.settings = settings;
    return config;
  }
  DdsBus& start(const DdsBusConfig& config) {
    auto bus = DdsBus::create(config);
    if (!bus) throw std::runtime_error(bus.error().message);
    buses_.push_back(*std::move(bus));
    return *buses_.back();
  }
  bool run_until(const std::function<bool()>& done) {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (std::chrono::steady_clock::now() < deadline) {
      for (const auto& bus : buses_) {
        if (bus->run_until(done, std::chrono::milliseconds(5))) return true;
      }
    }
    return done();
  }
  static std::size_t heard(const DdsBus& bus) { return bus.survey(Link::kLongRange).robots.size(); }

  CapturedLog log_;
  std::vector<std::unique_ptr<DdsBus>> buses_;
};

inline Hello some_hello() {
  Hello hello;
  hello.knows.fill(9);
  hello.sender = name("r2");
  hello.address = {10, 0, 0, 2};
  hello.port = 7660;
  hello.settings = kSettings;
  hello.link = Link::kShortRange;
  hello.reads = {1, 2, 3};
  return hello;
}

/// `payload` as one DATA submessage of RTPS 2.2 from the participant with prefix {participant, 2, 3, ...,
/// 12}.
inline Bytes rtps_message(const Bytes& payload, std::uint8_t number, std::uint8_t participant = 1) {
  Bytes bytes{'R', 'T', 'P', 'S', 2, 2, 1, 15, participant, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  const auto length = static_cast<std::uint16_t>(20 + payload.size());
  bytes.insert(bytes.end(),
               {0x15, 0x05, static_cast<std::uint8_t>(length), static_cast<std::uint8_t>(length >> 8)});
  bytes.insert(bytes.end(), {0, 0, 16, 0});       // offset of what follows the sequence number
  bytes.insert(bytes.end(), {0, 0, 0, 0});        // to any reader
  bytes.insert(bytes.end(), {0xff, 0, 1, 0x03});  // of this writer
  bytes.insert(bytes.end(), {0, 0, 0, 0, number, 0, 0, 0});
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  return bytes;
}

inline void send_to(std::uint16_t port, const Bytes& bytes) {
  const int fd = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  sendto(fd, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  close(fd);
}

}  // namespace fleetmap::bus::testing
