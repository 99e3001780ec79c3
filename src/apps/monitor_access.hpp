#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>

#include "fleetmap/core/result.hpp"
#include "fleetmap/monitor/server.hpp"

namespace fleetmap::apps {

/// Address of the page and who may look at it; every command that serves it has these options.
struct MonitorAccess {
  std::optional<std::uint16_t> port;  ///< no page without one
  std::string address = "127.0.0.1";
  std::string token_file;
  std::size_t viewers = 8;
};

/// Adds --PREFIXaddress, --PREFIXtoken-file and --PREFIXviewers. The port is the command's own.
void add_access_options(CLI::App& command, MonitorAccess& access, const std::string& prefix);

/// Adds --monitor, which serves the page beside what the command does, and --monitor-address and so on.
/// `content` ends its description.
void add_page_options(CLI::App& command, MonitorAccess& access, const std::string& content);

/// Makes a random token where the address is seen by others and no file gives one.
Result<monitor::ServerConfig> server_config(const MonitorAccess& access);
/// The same where a port is given; nothing without one, though wrong options are refused all the same.
Result<std::optional<monitor::ServerConfig>> config_of_page(const MonitorAccess& access);

}  // namespace fleetmap::apps
