#pragma once

#include <optional>
#include <string>

#include "access_options.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/monitor/server.hpp"

namespace CLI {
class App;
}

namespace fleetmap::apps {

/// Adds --PREFIXaddress, --PREFIXtoken-file and --PREFIXviewers. The port is the command's own.
void add_access_options(CLI::App& command, AccessOptions& access, const std::string& prefix);

/// Adds --monitor, which serves the page beside what the command does, and --monitor-address and so on.
/// `content` ends its description.
void add_page_options(CLI::App& command, AccessOptions& access, const std::string& content);

/// Makes a random token where the address is seen by others and no file gives one.
Result<monitor::ServerConfig> server_config(const AccessOptions& access);
/// The same where a port is given; nothing without one, though wrong options are refused all the same.
Result<std::optional<monitor::ServerConfig>> config_of_page(const AccessOptions& access);

}  // namespace fleetmap::apps
