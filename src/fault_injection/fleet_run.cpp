#include "fleetmap/fault_injection/fleet_run.hpp"

#include "faulty_fleet.hpp"
#include "fleetmap/core/work_folder.hpp"

namespace fleetmap::fault_injection {

Outcome run(const Scenario& scenario, const RunConfig& config) {
  if (!config.stores.empty()) return FaultyFleet(scenario, config, config.stores).run();
  const WorkFolder folder("fleetmap_fuzz");
  return FaultyFleet(scenario, config, folder.path()).run();
}

}  // namespace fleetmap::fault_injection
