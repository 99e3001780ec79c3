#pragma once

#include <cstdint>
#include <optional>

#include "fleetmap/messages/messages.hpp"

namespace fleetmap::messages {

/// The link that a message goes over.
enum class Reach : std::uint8_t { kLongRange, kShortRange };

/// A message that is due now.
struct Outgoing {
  Reach reach = Reach::kLongRange;
  /// The one agent that it is for; nothing means everyone in reach.
  std::optional<AgentId> to;
  Message message;
};

/// The link of a message for which there is no choice of links, or no other in reach.
Reach usual_reach(const Message& message);
/// What goes to all, but may be sent to one after the other: all such messages of the radio but orders, which
/// operators hear too.
bool may_go_one_by_one(const Message& message);
/// Who sent it; nothing for nodes and alignments, which any agent may pass on.
std::optional<AgentId> sender_of(const Message& message);
/// Whom it is for; nothing when it is for everyone.
std::optional<AgentId> recipient_of(const Message& message);

}  // namespace fleetmap::messages
