#include "offered_qos.hpp"

namespace fleetmap::recording {
namespace {

// rmw/types.h
constexpr char kHistory[] = "- history: 1\n  depth: ";
constexpr char kLive[] = "10\n  reliability: 1\n  durability: 2";
/// As many as a reader that comes late gets of the submaps, the topic with the most.
constexpr char kKept[] = "50\n  reliability: 1\n  durability: 1";
/// No deadline, no lifespan, automatic liveliness without a lease.
constexpr char kDeadlineToEnd[] =
    "\n  deadline:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  lifespan:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  liveliness: 1\n  liveliness_lease_duration:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  avoid_ros_namespace_conventions: false";

}  // namespace

std::string offered_qos(Durability durability) {
  return std::string(kHistory) + (durability == Durability::kTransientLocal ? kKept : kLive) + kDeadlineToEnd;
}

}  // namespace fleetmap::recording
