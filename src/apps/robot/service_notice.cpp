#include "service_notice.hpp"

#include <systemd/sd-daemon.h>

#include <chrono>
#include <cstdint>

namespace fleetmap::apps {

ServiceNotice::ServiceNotice(bus::Bus& bus) {
  std::uint64_t limit_us = 0;
  if (sd_watchdog_enabled(0, &limit_us) > 0) {
    // Half of the limit, as sd_watchdog_enabled(3) advises; a third leaves room for a slow callback.
    const Duration period = std::chrono::microseconds(limit_us / 3);
    feeding_ = bus.every(period, {"service watchdog", [] { sd_notify(0, "WATCHDOG=1"); }});
  }
  sd_notify(0, "READY=1");
}

ServiceNotice::~ServiceNotice() { sd_notify(0, "STOPPING=1"); }

}  // namespace fleetmap::apps
