#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "page/monitor_access.hpp"
#include "robot/record_options.hpp"

namespace fleetmap::apps {

/// A fleet in virtual time, as the command line has it.
struct RunOptions {
  std::string config;                   ///< FLEET.yaml, or
  std::vector<std::string> recordings;  ///< NAME=PATH of each robot
  std::string out;
  RecordOptions record;               ///< of a bag for each robot
  std::optional<std::size_t> agents;  ///< the first so many of the file
  unsigned threads = std::max(1u, std::thread::hardware_concurrency());
  std::uint16_t first_session = 0;
  std::vector<std::string> set;  ///< key=value
  AccessOptions monitor;
};

}  // namespace fleetmap::apps
