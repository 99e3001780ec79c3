#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace fleetmap::apps {

/// A mission that is planned without driving, as the command line has it.
struct PlanOptions {
  std::string site;                   ///< SITE.geojson
  std::string config;                 ///< AGENT.yaml or FLEET.yaml; empty: robots of default abilities
  std::string out;                    ///< GeoJSON; empty: the plan is only printed
  std::optional<std::size_t> agents;  ///< number of robots; of a file the first so many
  std::vector<std::string> set;       ///< key=value
};

}  // namespace fleetmap::apps
