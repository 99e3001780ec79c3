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
/// Whether a message to all may go to one robot after the other: all such radio messages, except orders,
/// which operators receive too.
bool may_go_one_by_one(const Message& message);
/// Sender of a message; none for nodes and alignments, which any robot may pass on.
std::optional<AgentId> sender_of(const Message& message);
/// Recipient of a message; none if it is for all.
std::optional<AgentId> recipient_of(const Message& message);

}  // namespace fleetmap::messages
