#include "service_notice.hpp"

#include <systemd/sd-daemon.h>

#include <chrono>
#include <cstdint>

namespace fleetmap::apps {

ServiceNotice::ServiceNotice(bus::Bus& bus) : bus_(bus) {
  std::uint64_t limit_us = 0;
  if (sd_watchdog_enabled(0, &limit_us) > 0) {
    // Half of the limit, as sd_watchdog_enabled(3) advises; a third leaves room for a slow callback.
    const Duration period = std::chrono::microseconds(limit_us / 3);
    feeding_ = bus.every(period, {"service watchdog", [this] {
                                    if (lanes_go_on()) sd_notify(0, "WATCHDOG=1");
                                  }});
  }
  sd_notify(0, "READY=1");
}

bool ServiceNotice::lanes_go_on() {
  constexpr std::array kLanes{bus::Lane::kPerception, bus::Lane::kBackground};
  bool go_on = true;
  for (std::size_t k = 0; k < kLanes.size(); ++k) {
    std::optional<Stamp>& since = (*waiting_)[k];
    go_on = go_on && (!since || bus_.now() - *since < kMaxWork);
    if (since) continue;
    // A lane that has no room is asked again.
    if (bus_.offload(kLanes[k], {"service watchdog", [] {}},
                     [waiting = waiting_, k] { (*waiting)[k].reset(); }))
      since = bus_.now();
  }
  return go_on;
}

ServiceNotice::~ServiceNotice() { sd_notify(0, "STOPPING=1"); }

}  // namespace fleetmap::apps
