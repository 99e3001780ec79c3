#include "fleetmap/bus/local_network_config.hpp"

#include <cmath>
#include <string>

namespace fleetmap::bus {
namespace {

Status validate_radio(const RadioConfig& radio, const std::string& name) {
  const auto wrong = [&](const char* rule) { return failure(name + "." + rule); };
  if (!(std::isfinite(radio.rate_bit_s) && radio.rate_bit_s > 0.0))
    return wrong("rate_bit_s must be > 0 bit/s");
  if (radio.delay < Duration::zero()) return wrong("delay must be >= 0");
  if (!(radio.loss >= 0.0 && radio.loss < 1.0)) return wrong("loss must be in [0, 1)");
  if (!(std::isfinite(radio.max_range) && radio.max_range >= 0.0)) return wrong("max_range must be >= 0 m");
  if (radio.queue_capacity == 0) return wrong("queue_capacity must be > 0");
  if (radio.overhead.max_datagram_payload == 0) return wrong("overhead.max_datagram_payload must be > 0");
  return {};
}

}  // namespace

Status LocalNetworkConfig::validate() const {
  if (auto status = validate_radio(long_range, "long_range"); !status) return status;
  if (auto status = validate_radio(short_range, "short_range"); !status) return status;
  if (onboard_queue_capacity == 0) return failure("onboard_queue_capacity must be > 0");
  if (perception_time < Duration::zero()) return failure("perception_time must be >= 0");
  if (background_time < Duration::zero()) return failure("background_time must be >= 0");
  return {};
}

}  // namespace fleetmap::bus
