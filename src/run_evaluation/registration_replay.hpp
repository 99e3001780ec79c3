#pragma once

#include <string>
#include <utility>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/registration/register_clouds.hpp"
#include "fleetmap/store/registration_log.hpp"
#include "run_folder.hpp"
#include "stored_fleet.hpp"

namespace fleetmap::run_evaluation {

/// The result of registering a run's loop candidates by one method.
struct ReplayedRegistrations {
  std::vector<graph::Alignment> alignments;  ///< the accepted and ambiguous ones, named as agents name theirs
  std::size_t accepted = 0, ambiguous = 0, rejected = 0;
  double cpu_seconds = 0.0;
  std::vector<std::string> notes;  ///< pairs that could not be read or registered
};

/// The registrations that a run's agents logged.
struct RegistrationLogs {
  /// The method that they used; `correlation` where none logged a registration.
  registration::Method method = registration::Method::correlation;
  std::vector<std::pair<AgentId, std::vector<store::LoggedRegistration>>> by_agent;
  std::vector<std::string> notes;  ///< pairs that could not be read
};
RegistrationLogs read_registration_logs(const RunFolder& run);

/// Registers the logged pairs of nodes once more by `method`: the same clouds and, if the method uses it, the
/// same prior. `held` gives the nodes. The settings are the method's defaults.
ReplayedRegistrations register_again(const RegistrationLogs& logs, const StoredFleet& held,
                                     registration::Method method);

}  // namespace fleetmap::run_evaluation
