#pragma once

#include <iosfwd>

#include "fleetmap/config/robot_config.hpp"
#include "fleetmap/core/result.hpp"
#include "network_check_options.hpp"

namespace fleetmap::apps {

/// Listens on the radios of `robot` and prints to `out`, per link, who is heard, who never was and what
/// differs. True if all are heard and nothing differs. It sends Hellos of its own, which agents take for an
/// operator's.
Result<bool> check_network(const config::RobotConfig& robot, const NetworkCheckOptions& options,
                           std::ostream& out);

}  // namespace fleetmap::apps
