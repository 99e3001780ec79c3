#include "fleetmap/messages/routing.hpp"

namespace fleetmap::messages {

Reach usual_reach(const Message& message) {
  const bool is_short = std::holds_alternative<SubmapDigest>(message) ||
                        std::holds_alternative<SubmapRequest>(message) ||
                        std::holds_alternative<SubmapChunk>(message);
  return is_short ? Reach::kShortRange : Reach::kLongRange;
}

bool may_go_one_by_one(const Message& message) {
  return !recipient_of(message) && usual_reach(message) == Reach::kLongRange &&
         !std::holds_alternative<Hold>(message);
}

std::optional<AgentId> sender_of(const Message& message) {
  return std::visit(
      [](const auto& m) -> std::optional<AgentId> {
        if constexpr (requires { m.from; }) {
          return m.from;
        } else {
          return std::nullopt;
        }
      },
      message);
}

std::optional<AgentId> recipient_of(const Message& message) {
  return std::visit(
      [](const auto& m) -> std::optional<AgentId> {
        if constexpr (requires { m.to; }) {
          return m.to;
        } else {
          return std::nullopt;
        }
      },
      message);
}

}  // namespace fleetmap::messages
