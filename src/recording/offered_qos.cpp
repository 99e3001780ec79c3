#include "offered_qos.hpp"

namespace fleetmap::recording {
namespace {

// rmw/types.h
constexpr char kHistoryToReliability[] = "- history: 1\n  depth: 10\n  reliability: 1\n  durability: ";
/// No deadline, no lifespan, automatic liveliness without a lease.
constexpr char kDeadlineToEnd[] =
    "\n  deadline:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  lifespan:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  liveliness: 1\n  liveliness_lease_duration:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  avoid_ros_namespace_conventions: false";

}  // namespace

std::string offered_qos(Durability durability) {
  return std::string(kHistoryToReliability) + (durability == Durability::kTransientLocal ? "1" : "2") +
         kDeadlineToEnd;
}

}  // namespace fleetmap::recording
