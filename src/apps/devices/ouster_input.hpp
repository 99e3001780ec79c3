#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>

#include "datagram_input.hpp"
#include "fleetmap/agent/ouster_config.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/sensor/ouster_sensor.hpp"

namespace fleetmap::apps {

/// An Ouster LiDAR without a driver: makes scans and IMU samples of the packets that it sends to two UDP
/// ports of this machine.
class OusterInput {
 public:
  /// Each is called on the thread of its port.
  struct Handlers {
    std::function<void(const sensor::Scan&)> on_scan;
    std::function<void(const sensor::Imu&)> on_imu;
  };
  struct Counters {
    DatagramInput::Counters lidar, imu;   ///< of the ports
    std::uint64_t incomplete_sweeps = 0;  ///< left out
    std::uint64_t scans = 0, imus = 0;    ///< handed on
  };

  /// Fails with the key of the port and the reason, as when another program receives there.
  static Result<std::unique_ptr<OusterInput>> open(const agent::OusterConfig& config, Handlers handlers);

  /// From any thread.
  Counters counters() const;

 private:
  OusterInput(const sensor::OusterMetadata& metadata, Handlers handlers)
      : handlers_(std::move(handlers)), sensor_(metadata) {}
  tl::expected<void, sensor::PacketRefusal> add_lidar(ByteView packet, Stamp arrival);
  tl::expected<void, sensor::PacketRefusal> add_imu(ByteView packet, Stamp arrival);

  Handlers handlers_;
  mutable std::mutex mutex_;
  sensor::OusterSensor sensor_;                 ///< guarded by mutex_
  std::uint64_t scans_ = 0, imus_ = 0;          ///< guarded by mutex_
  std::unique_ptr<DatagramInput> lidar_, imu_;  ///< with the threads
};

}  // namespace fleetmap::apps
