#include "options.hpp"

#include <csignal>

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

const std::atomic<bool>& stop_on_signals() {
  for (const int signal : {SIGINT, SIGTERM}) {
    std::signal(signal, [](int) { stop_requested = true; });
  }
  return stop_requested;
}

}  // namespace fleetmap::apps
