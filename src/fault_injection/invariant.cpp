#include "fleetmap/fault_injection/invariant.hpp"

#include <array>
#include <cstdio>
#include <sstream>

#include "names.hpp"

namespace fleetmap::fault_injection {
namespace {

constexpr std::array<const char*, kInvariants> kInvariantNames{
    "converges", "completes", "same_map", "nothing_lost", "budget", "bounded",
    "alive",     "own_items", "starts",   "truth",        "rows",   "named"};

}  // namespace

const char* to_string(Invariant invariant) { return kInvariantNames.at(static_cast<std::size_t>(invariant)); }

Result<std::set<Invariant>> parse_invariants(std::string_view names) {
  return parse_names<Invariant>(names, kInvariantNames);
}

std::string to_string(const Violation& violation) {
  char at[32];
  std::snprintf(at, sizeof at, "%.2f s", to_seconds(violation.at));
  return std::string(to_string(violation.invariant)) + " at " + at + ", " +
         (violation.robot.empty() ? "fleet" : violation.robot) + ": " + violation.what;
}

}  // namespace fleetmap::fault_injection
