#include "trace.hpp"

#include <cstdio>
#include <variant>

namespace fleetmap::fault_injection {

void Trace::add(Duration time, const std::string& line) {
  if (!on_) return;
  char stamp[32];
  std::snprintf(stamp, sizeof stamp, "%9.2f s  ", to_seconds(time));
  lines_.push_back(stamp + line);
}

std::optional<std::string> trace_line(const exchange::Event& event) {
  if (const auto* conflict = std::get_if<exchange::ItemConflict>(&event))
    return "conflict " + to_string(conflict->id);
  if (const auto* refused = std::get_if<exchange::ItemRefused>(&event))
    return to_string(refused->id) + " is refused: " + to_string(refused->proof);
  if (const auto* failed = std::get_if<exchange::StoreFailed>(&event)) return failed->error.message;
  if (const auto* elsewhere = std::get_if<exchange::OwnItemsElsewhere>(&event))
    return elsewhere->peer.str() + " holds own items that the store lacks";
  return std::nullopt;
}

}  // namespace fleetmap::fault_injection
