#include "fault_changes.hpp"

#include <algorithm>

namespace fleetmap::fault_injection {

std::vector<FaultChange> changes_of(const Scenario& scenario) {
  std::vector<FaultChange> changes;
  for (std::size_t k = 0; k < scenario.faults.size(); ++k) {
    const Fault& fault = scenario.faults[k];
    if (fault.kind == FaultKind::kOldStore)
      changes.push_back({fault.begin - from_seconds(fault.value), k, FaultChange::Kind::kBackup});
    changes.push_back({fault.begin, k, FaultChange::Kind::kBegin});
    changes.push_back({std::min(fault.begin + fault.length, scenario.mapping), k, FaultChange::Kind::kEnd});
  }
  std::ranges::stable_sort(changes, {}, &FaultChange::at);
  return changes;
}

}  // namespace fleetmap::fault_injection
