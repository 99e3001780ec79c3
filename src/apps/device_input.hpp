#pragma once

#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "device_stream.hpp"
#include "fleetmap/core/time.hpp"

namespace fleetmap::apps {

/// Reads a device on a thread of its own. One that is missing or vanishes is tried again every second; each
/// failure is logged once, and so is a device that is there and silent.
class DeviceInput {
 public:
  struct Handlers {
    /// Called on the input's thread with the time of arrival.
    std::function<void(ByteView, Stamp)> on_bytes;
    /// Sent to the device once it is connected; may be empty.
    std::function<Bytes()> greeting{};
    /// Sent every second once it was heard; may be empty.
    std::function<Bytes(Stamp)> request{};
  };
  DeviceInput(agent::DevicePlace place, Handlers handlers);
  /// The reason why the device is not heard, with the remedy; empty while it is heard or nothing is known.
  std::string trouble() const;

 private:
  void run(const std::stop_token& stop);
  /// Until the device is gone.
  Error serve(DeviceStream& stream, const std::stop_token& stop);
  /// Keeps `trouble`, and logs it with `then` unless it is that of before.
  void say(const std::string& trouble, const char* then);
  void hear();

  agent::DevicePlace place_;
  Handlers handlers_;
  mutable std::mutex mutex_;
  std::string trouble_;  ///< guarded by mutex_
  std::jthread thread_;
};

}  // namespace fleetmap::apps
