#pragma once

#include "fleetmap/bus/bus.hpp"

namespace fleetmap::apps {

/// Tells systemd that a service of Type=notify is ready, that it makes progress, and that it ends. Without
/// systemd it does nothing.
class ServiceNotice {
 public:
  /// Ready. As long as this lives and the callbacks of the bus run, the watchdog of the service is fed.
  explicit ServiceNotice(bus::Bus& bus);
  ServiceNotice(const ServiceNotice&) = delete;
  ServiceNotice& operator=(const ServiceNotice&) = delete;
  ~ServiceNotice();  ///< stopping

 private:
  bus::Handle feeding_;
};

}  // namespace fleetmap::apps
