#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"

namespace fleetmap::fault_injection {

/// A property that every fleet must have, whatever goes wrong.
enum class Invariant : std::uint8_t {
  kConverges,  ///< all robots hold the same items, have caught up and are idle, in time after the last fault
  kCompletes,  ///< then all of them find their map complete as well
  kSameMap,    ///< robots with the same items have the same placement and map, bit for bit
  kNothingLost,  ///< the items that a robot announced as held are on its disk, and with everyone in the end
  kBudget,       ///< the radio carries no more than it may in any second
  kBounded,      ///< queues and tables stay within their bounds
  kAlive,        ///< every robot that runs sends something at least every so often
  kOwnItems,     ///< no robot refuses an item that its maker made
  kStarts,       ///< a robot whose disk works starts
  kTruth,  ///< honest robots' nodes are placed where GPS errors allow, whatever a compromised robot adds
  kRows,   ///< no honest robot counts a row as driven that nobody drove, unless packets are forged
  kNamed,  ///< a robot whose items contradict the fleet is named, and no honest one
};

inline constexpr std::size_t kInvariants = 12;

const char* to_string(Invariant invariant);

/// Parses names separated by commas, or "all".
Result<std::set<Invariant>> parse_invariants(std::string_view names);

/// An invariant that a fleet violated, and when.
struct Violation {
  Invariant invariant;
  Duration at;        ///< since the fleet's start
  std::string robot;  ///< empty: the fleet
  std::string what;
};

std::string to_string(const Violation& violation);

}  // namespace fleetmap::fault_injection
