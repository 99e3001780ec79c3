#include "fleetmap/bus/dds_bus_config.hpp"

#include <array>
#include <string>

#include "participant_qos.hpp"

namespace fleetmap::bus {
const DdsLinkConfig& config_of(const DdsBusConfig& config, Link link) {
  switch (link) {
    case Link::kLongRange:
      return config.long_range;
    case Link::kShortRange:
      return config.short_range;
    case Link::kOnboard:
      break;
  }
  return config.onboard;
}

Status DdsBusConfig::validate() const {
  if (agent.empty()) return failure("agent must have a name");
  if (onboard.multicast) return failure("onboard.multicast is for radios; leave it out");
  for (const Link link : kLinks) {
    const DdsLinkConfig& own = config_of(*this, link);
    if (!own.enabled) continue;
    if (auto status = bus::validate(own, to_string(link)); !status) return status;
    for (const Link other : kLinks) {
      const bool clash =
          other < link && config_of(*this, other).enabled && config_of(*this, other).domain == own.domain;
      if (clash)
        return failure(std::string(to_string(link)) + ".domain must differ from " + to_string(other) + "'s");
    }
  }
  return {};
}

}  // namespace fleetmap::bus
