#include "fleetmap/bus/link.hpp"

namespace fleetmap::bus {

const char* to_string(Link link) {
  switch (link) {
    case Link::kOnboard:
      return "onboard";
    case Link::kLongRange:
      return "long_range";
    case Link::kShortRange:
      return "short_range";
  }
  return "unknown";
}

}  // namespace fleetmap::bus
