#include "fleetmap/fault_injection/fault.hpp"

#include <array>
#include <cstdio>
#include <sstream>

#include "names.hpp"

namespace fleetmap::fault_injection {
namespace {

constexpr std::array<const char*, kFaultKinds> kKindNames{
    "loss",       "delay",         "duplication", "one_way",     "partition", "crash",
    "lost_store", "old_store",     "full_disk",   "clock_step",  "stranger",  "forged",
    "liar",       "damaged_store", "compromised", "many_starts", "new_origin"};

}  // namespace

const char* to_string(FaultKind kind) { return kKindNames.at(static_cast<std::size_t>(kind)); }

bool stops_robot(FaultKind kind) {
  switch (kind) {
    case FaultKind::kCrash:
    case FaultKind::kClockStep:
    case FaultKind::kLostStore:
    case FaultKind::kOldStore:
    case FaultKind::kDamagedStore:
    case FaultKind::kManyStarts:
      return true;
    default:
      return false;
  }
}

Result<std::set<FaultKind>> parse_fault_kinds(std::string_view names) {
  return parse_names<FaultKind>(names, kKindNames);
}

std::string to_string(const Fault& fault) {
  std::ostringstream out;
  out.precision(4);
  out << "at " << to_seconds(fault.begin) << " s for " << to_seconds(fault.length)
      << " s: " << to_string(fault.kind);
  if (fault.value != 0.0) out << ' ' << fault.value;
  for (std::size_t k = 0; k < fault.robots.size(); ++k)
    out << (k == 0 ? " of r" : ", r") << fault.robots[k] + 1;
  if (impairs_links(fault.kind) && !(fault.radio && fault.short_range))
    out << (fault.radio ? ", radio" : ", short range");
  return out.str();
}

}  // namespace fleetmap::fault_injection
