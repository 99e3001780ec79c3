#pragma once

#include <functional>
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

 private:
  void run(const std::stop_token& stop);
  /// Until the device is gone.
  Error serve(DeviceStream& stream, const std::stop_token& stop);
  /// Logs it unless it is what was logged last.
  void say(const std::string& what);

  agent::DevicePlace place_;
  Handlers handlers_;
  std::string reported_;
  std::jthread thread_;
};

}  // namespace fleetmap::apps
