#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/fault_injection/scenario.hpp"

namespace fleetmap::fault_injection {

/// A property that every fleet must have, whatever goes wrong.
enum class Invariant : std::uint8_t {
  kConverges,  ///< all robots hold the same items, have caught up and are idle, in time after the last fault
  kCompletes,  ///< then all of them find their map complete as well
  kSameMap,    ///< robots with the same items have the same placement and map, bit for bit
  kNothingLost,  ///< what a robot told that it holds is on its disk, and with everyone in the end
  kBudget,       ///< the radio carries no more than it may in any second
  kBounded,      ///< queues and tables stay within their bounds
  kAlive,        ///< every robot that runs sends something at least every so often
  kOwnItems,     ///< nobody refuses an item that its maker made
  kStarts,       ///< a robot whose disk works starts
};
inline constexpr std::size_t kInvariants = 9;
const char* to_string(Invariant invariant);
/// Of names separated by commas, or "all".
Result<std::set<Invariant>> parse_invariants(std::string_view names);

struct Violation {
  Invariant invariant;
  Duration at;        ///< since the fleet's start
  std::string robot;  ///< empty: the fleet
  std::string what;
};
std::string to_string(const Violation& violation);

struct RunConfig {
  /// s after the last fault, in which all must have converged.
  Duration settling = std::chrono::minutes(10);
  std::set<Invariant> invariants;  ///< that are checked
  bool trace = false;
  /// Robots sign their items, forged items bear wrong signatures, and a liar alters items of others that it
  /// hands over.
  bool signatures = false;
};

struct Outcome {
  std::vector<Violation> violations;   ///< the first of each invariant and robot
  Duration converged_after{};          ///< the last fault
  double most_bytes_per_second = 0.0;  ///< of all robots on the radio
  std::size_t nodes = 0, alignments = 0;
  std::uint64_t packets = 0;
  std::uint64_t fingerprint = 0;  ///< of every packet: equal runs have equal ones
  std::vector<std::string> trace;
};

/// The fleet of the scenario, from its start until it has converged or may no longer.
Outcome run(const Scenario& scenario, const RunConfig& config);

}  // namespace fleetmap::fault_injection
