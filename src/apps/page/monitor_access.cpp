#include "monitor_access.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <sstream>

#include "fleetmap/monitor/request_check.hpp"
#include "validators.hpp"

namespace fleetmap::apps {
namespace {

Result<std::string> token_in(const std::string& file) {
  std::ostringstream text;
  if (std::ifstream in(file, std::ios::binary); in) text << in.rdbuf();
  std::string token = std::move(text).str();
  while (!token.empty() && std::isspace(static_cast<unsigned char>(token.back()))) token.pop_back();
  const bool plain =
      std::ranges::all_of(token, [](char c) { return std::isalnum(static_cast<unsigned char>(c)); });
  if (token.size() < monitor::kMinTokenLength || !plain)
    return failure(file + ": expected a token of at least 16 letters and digits");
  return token;
}

}  // namespace

void add_access_options(CLI::App& command, AccessOptions& access, const std::string& prefix) {
  command.add_option("--" + prefix + "address", access.address,
                     "address that the page listens on; any but 127.0.0.1 needs the token that is printed");
  command
      .add_option("--" + prefix + "token-file", access.token_file,
                  "file with the page's token, instead of a random one")
      ->check(some_path());
  command
      .add_option("--" + prefix + "viewers", access.viewers,
                  "pages and Foxglove clients that may be open at once")
      ->check(whole_number(1, 64));
}

void add_page_options(CLI::App& command, AccessOptions& access, const std::string& content) {
  command
      .add_option("--monitor", access.port,
                  "TCP port, 0 for any that is free: serve the page of `fleetmap monitor` " + content)
      ->check(whole_number(0, 65535));
  add_access_options(command, access, "monitor-");
}

Result<monitor::ServerConfig> server_config(const AccessOptions& access) {
  monitor::ServerConfig config;
  config.address = access.address;
  config.port = access.port.value_or(0);
  config.max_viewers = access.viewers;
  if (!access.token_file.empty()) {
    auto token = token_in(access.token_file);
    if (!token) return tl::unexpected(token.error());
    config.token = std::move(*token);
  } else if (!monitor::is_loopback(access.address)) {
    config.token = monitor::random_token();
  }
  if (const Status valid = config.validate(); !valid) return tl::unexpected(valid.error());
  return config;
}

Result<std::optional<monitor::ServerConfig>> config_of_page(const AccessOptions& access) {
  auto config = server_config(access);
  if (!config) return tl::unexpected(config.error());
  return access.port ? std::optional(std::move(*config)) : std::nullopt;
}

}  // namespace fleetmap::apps
