#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/sensor/packet_refusal.hpp"

namespace fleetmap::apps {

/// Receives the datagrams of one device on a UDP port of this machine, on a thread of its own. Those from
/// another address are refused while the first one sends.
class DatagramInput {
 public:
  /// Called on the input's thread. A payload that is refused is no sign of the device.
  using OnDatagram =
      std::function<tl::expected<void, sensor::PacketRefusal>(ByteView payload, Stamp arrival)>;
  struct Counters {
    std::uint64_t datagrams = 0;         ///< received
    std::uint64_t refused = 0;           ///< of which are no packets that are decoded
    std::uint64_t of_other_devices = 0;  ///< of which came from another address
  };

  /// `port` 0: any that is free. Fails with the configuration's key, the port and the reason, as when another
  /// program receives there, and names its `topic` as remedy.
  static Result<std::unique_ptr<DatagramInput>> open(std::uint16_t port, const std::string& key,
                                                     const std::string& topic, OnDatagram on_datagram);
  ~DatagramInput();
  DatagramInput(const DatagramInput&) = delete;
  DatagramInput& operator=(const DatagramInput&) = delete;

  std::uint16_t port() const { return port_; }
  /// From any thread.
  Counters counters() const;

 private:
  struct Datagram {
    ByteView payload;
    std::uint32_t source = 0;
    Stamp arrival;
  };
  DatagramInput(int socket, std::uint16_t port, OnDatagram on_datagram);
  void receive(const std::stop_token& stop);
  std::optional<Datagram> read();
  void handle(const Datagram& datagram);
  bool is_device(const Datagram& datagram) const;
  void count(std::uint64_t Counters::*counter, const std::string& what);

  int socket_;
  std::uint16_t port_;
  OnDatagram on_datagram_;
  std::vector<std::uint8_t> buffer_;  ///< this and the next two are touched by the thread alone
  std::optional<std::uint32_t> device_;
  Stamp last_packet_;
  mutable std::mutex mutex_;
  Counters counters_;  ///< guarded by mutex_
  std::jthread thread_;
};

}  // namespace fleetmap::apps
