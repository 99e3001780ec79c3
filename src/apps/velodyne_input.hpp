#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "fleetmap/core/result.hpp"
#include "fleetmap/sensor/velodyne_sweeps.hpp"

namespace fleetmap::apps {

/// A Velodyne LiDAR without a driver: receives its packets on a UDP port of this machine, on a thread of its
/// own, and makes scans of them. One device a port: packets from another address are refused while the first
/// one sends.
class VelodyneInput {
 public:
  /// Called on the input's thread.
  using OnScan = std::function<void(const sensor::Scan&)>;
  struct Counters {
    std::uint64_t datagrams = 0;          ///< received
    std::uint64_t refused = 0;            ///< of which are no packets that are decoded
    std::uint64_t of_other_devices = 0;   ///< of which came from another address
    std::uint64_t incomplete_sweeps = 0;  ///< left out
    std::uint64_t scans = 0;              ///< handed on
  };

  /// `port` 0: any that is free. Fails with the port and the reason, as when another program receives there.
  static Result<std::unique_ptr<VelodyneInput>> open(std::uint16_t port, OnScan on_scan);
  ~VelodyneInput();
  VelodyneInput(const VelodyneInput&) = delete;
  VelodyneInput& operator=(const VelodyneInput&) = delete;

  std::uint16_t port() const { return port_; }
  /// From any thread.
  Counters counters() const;

 private:
  struct Datagram {
    ByteView payload;
    std::uint32_t source = 0;
    Stamp arrival;
  };
  VelodyneInput(int socket, std::uint16_t port, OnScan on_scan);
  void receive(const std::stop_token& stop);
  std::optional<Datagram> read();
  void handle(const Datagram& datagram);
  bool is_device(const Datagram& datagram);
  void warn(std::uint64_t count, const std::string& what) const;

  int socket_;
  std::uint16_t port_;
  OnScan on_scan_;
  std::array<std::uint8_t, 2048> buffer_{};
  sensor::VelodyneSweeps sweeps_;  ///< this and the next two are touched by the thread alone
  std::optional<std::uint32_t> device_;
  Stamp last_packet_;
  mutable std::mutex mutex_;
  Counters counters_;  ///< guarded by mutex_
  std::jthread thread_;
};

}  // namespace fleetmap::apps
