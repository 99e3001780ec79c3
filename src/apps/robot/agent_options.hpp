#pragma once

#include <string>
#include <vector>

#include "page/monitor_access.hpp"
#include "record_options.hpp"

namespace fleetmap::apps {

/// One robot over DDS, as the command line has it.
struct AgentOptions {
  std::string config;  ///< AGENT.yaml, or FLEET.yaml with `as`
  RecordOptions record;
  std::string as;                ///< agent of the fleet; empty: the file has one robot
  std::string out = ".";         ///< with `as`: parent of the agent's folder
  double exit_after_idle = 0.0;  ///< s; 0: never
  std::vector<std::string> set;  ///< key=value
  AccessOptions monitor;
};

}  // namespace fleetmap::apps
