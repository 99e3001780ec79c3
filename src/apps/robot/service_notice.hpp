#pragma once

#include <array>
#include <memory>
#include <optional>

#include "fleetmap/bus/bus.hpp"

namespace fleetmap::apps {

/// Tells systemd that a service of Type=notify is ready, that it makes progress, and that it ends. Without
/// systemd it does nothing.
class ServiceNotice {
 public:
  /// A piece of work that takes longer hangs: the map of a large site takes minutes on a small computer.
  static constexpr Duration kMaxWork = std::chrono::minutes(10);

  /// Ready. As long as this lives, the callbacks of the bus run, and none of its lanes stays with one piece
  /// of work for longer than kMaxWork, the watchdog of the service is fed.
  explicit ServiceNotice(bus::Bus& bus);
  ServiceNotice(const ServiceNotice&) = delete;
  ServiceNotice& operator=(const ServiceNotice&) = delete;
  ~ServiceNotice();  ///< stopping

 private:
  /// Since when work that was put behind that of each lane waits, if it does.
  using Waiting = std::array<std::optional<Stamp>, 2>;
  bool lanes_go_on();

  bus::Bus& bus_;
  std::shared_ptr<Waiting> waiting_ = std::make_shared<Waiting>();  ///< also of the work that comes back
  bus::Handle feeding_;
};

}  // namespace fleetmap::apps
