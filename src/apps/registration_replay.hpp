#pragma once

#include <string>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/registration/register_clouds.hpp"
#include "run_folder.hpp"

namespace fleetmap::apps {

/// The result of registering a run's encounters by one method.
struct ReplayedRegistrations {
  std::vector<graph::Alignment> alignments;  ///< the accepted and ambiguous ones, named as agents name theirs
  std::size_t accepted = 0, ambiguous = 0, rejected = 0;
  double cpu_seconds = 0.0;
  std::vector<std::string> notes;  ///< what could not be read
};

/// The method that the run's agents used; `correlation` where no agent logged a registration.
registration::Method method_of(const RunFolder& run);

/// Registers the pairs of nodes that the run's agents registered once more by `method`: the same clouds and,
/// if the method uses it, the same prior. `held` gives the nodes. The settings are the method's defaults.
ReplayedRegistrations register_again(const RunFolder& run, const HeldFleet& held,
                                     registration::Method method);

}  // namespace fleetmap::apps
