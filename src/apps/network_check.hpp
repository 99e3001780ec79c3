#pragma once

#include <cstdint>
#include <utility>

#include "fleetmap/config/robot_config.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::apps {

struct NetworkCheckOptions {
  double seconds = 10.0;
  /// In which robots that were not heard are looked for: first and last.
  std::pair<std::uint32_t, std::uint32_t> domains{0, 15};
};

/// Listens on the radios of `robot` and prints per link who is heard, who never was and what differs. True if
/// all are heard and nothing differs. It sends Hellos of its own, which agents take for an operator's.
Result<bool> check_network(const config::RobotConfig& robot, const NetworkCheckOptions& options);

}  // namespace fleetmap::apps
