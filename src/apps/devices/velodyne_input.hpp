#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>

#include "datagram_input.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/sensor/velodyne_sweeps.hpp"

namespace fleetmap::apps {

/// A Velodyne LiDAR without a driver: makes scans of the packets that it sends to a UDP port of this machine.
class VelodyneInput {
 public:
  /// Called on the input's thread.
  using OnScan = std::function<void(const sensor::Scan&)>;
  struct Counters {
    DatagramInput::Counters input;
    std::uint64_t incomplete_sweeps = 0;  ///< left out
    std::uint64_t scans = 0;              ///< handed on
  };

  /// `port` 0: any that is free. Fails with the port and the reason, as when another program receives there.
  static Result<std::unique_ptr<VelodyneInput>> open(std::uint16_t port, OnScan on_scan);

  std::uint16_t port() const { return input_->port(); }
  /// From any thread.
  Counters counters() const;

 private:
  explicit VelodyneInput(OnScan on_scan) : on_scan_(std::move(on_scan)) {}
  tl::expected<void, sensor::PacketRefusal> add(ByteView packet, Stamp arrival);

  OnScan on_scan_;
  sensor::VelodyneSweeps sweeps_;  ///< touched by the thread alone
  mutable std::mutex mutex_;
  Counters counters_;                     ///< guarded by mutex_, but for `input`
  std::unique_ptr<DatagramInput> input_;  ///< with the thread
};

}  // namespace fleetmap::apps
