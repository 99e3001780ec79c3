#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"

namespace fleetmap::fault_injection {

/// Kinds of faults that a simulated fleet is exposed to.
enum class FaultKind : std::uint8_t {
  kLoss,          ///< a share `value` of packets is lost
  kDelay,         ///< packets take up to `value` s more, so that they overtake each other
  kDuplication,   ///< a share `value` of packets arrives twice
  kOneWay,        ///< the first robot is not heard by the second
  kPartition,     ///< the robots named and the others do not hear each other
  kCrash,         ///< killed, and started again after `length`
  kLostStore,     ///< killed, and started again on an empty disk
  kOldStore,      ///< killed, and started again with the store of `value` s before
  kFullDisk,      ///< every write to the store fails
  kClockStep,     ///< killed, and started again with a clock that is `value` s off
  kStranger,      ///< `value` packets a second of senders outside the fleet, and replayed ones
  kForged,        ///< `value` packets a second in the names of robots of the fleet
  kLiar,          ///< the robot lies in its digests, status and pieces of clouds and submaps
  kDamagedStore,  ///< killed, and started again with a page of its database damaged, at share `value` of it
  kCompromised,   ///< a member with valid keys whose nodes, alignments, clouds, digests, chunks and
                  ///< mission reports are false
  kManyStarts,    ///< the robot starts `value` times, and is killed at once each time
  kNewOrigin,     ///< the robot's odometry begins anew
};

inline constexpr std::size_t kFaultKinds = 17;

const char* to_string(FaultKind kind);
/// Faults of links name the link that they impair: radio, short range or both.
constexpr bool impairs_links(FaultKind kind) { return kind <= FaultKind::kPartition; }

/// Faults that keep their robot from running.
bool stops_robot(FaultKind kind);

/// Parses names separated by commas, or "all".
Result<std::set<FaultKind>> parse_fault_kinds(std::string_view names);

/// A fault of a link or robot over an interval of the simulation.
struct Fault {
  FaultKind kind = FaultKind::kLoss;
  Duration begin{};  ///< since the fleet's start
  Duration length{};
  std::vector<std::size_t> robots;  ///< whom it concerns; none: all
  bool radio = true;                ///< of faults of links: on the long range
  bool short_range = true;
  double value = 0.0;
};

std::string to_string(const Fault& fault);

}  // namespace fleetmap::fault_injection
