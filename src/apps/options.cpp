#include "options.hpp"

#include <unistd.h>

#include <csignal>
#include <system_error>

#include "fleetmap/core/paths.hpp"

namespace fleetmap::apps {
namespace {

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

}  // namespace

Result<std::vector<config::Override>> parse_overrides(const std::vector<std::string>& texts) {
  std::vector<config::Override> overrides;
  for (const std::string& text : texts) {
    auto parsed = config::parse_override(text);
    if (!parsed) return tl::unexpected(parsed.error());
    overrides.push_back(std::move(*parsed));
  }
  return overrides;
}

Status check_writable(const std::filesystem::path& directory) {
  if (!is_folder(directory)) return failure(directory.string() + ": is no folder");
  if (::access(directory.c_str(), W_OK | X_OK) != 0)
    return failure(directory.string() +
                   ": cannot be written to; check its permissions or give another folder");
  return {};
}

Status make_writable(const std::filesystem::path& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) return failure(directory.string() + ": cannot be made: " + error.message());
  return check_writable(directory);
}

const std::atomic<bool>& stop_on_signals() {
  for (const int signal : {SIGINT, SIGTERM}) {
    std::signal(signal, [](int) { stop_requested = true; });
  }
  return stop_requested;
}

}  // namespace fleetmap::apps
