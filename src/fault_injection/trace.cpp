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

std::string trace_line(const messages::Message& message) {
  if (const auto* node = std::get_if<graph::Node>(&message)) return "node " + to_string(node->id);
  if (const auto* alignment = std::get_if<graph::Alignment>(&message))
    return "alignment " + to_string(NodeId{alignment->computed_by, alignment->seq});
  return "message " + std::to_string(message.index());
}

std::optional<std::string> trace_line(const exchange::Event& event) {
  if (const auto* conflict = std::get_if<exchange::ItemConflict>(&event))
    return std::string(conflict->alignment ? "conflict alignment " : "conflict node ") +
           to_string(conflict->id);
  if (const auto* refused = std::get_if<exchange::ItemRefused>(&event))
    return to_string(refused->id) + " is refused: " + to_string(refused->proof);
  if (const auto* failed = std::get_if<exchange::StoreFailed>(&event)) return failed->error.message;
  if (const auto* elsewhere = std::get_if<exchange::OwnItemsElsewhere>(&event))
    return elsewhere->peer.str() + " holds own items that the store lacks";
  return std::nullopt;
}

}  // namespace fleetmap::fault_injection
