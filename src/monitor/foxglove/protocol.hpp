#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "channel.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"

/// The Foxglove WebSocket protocol, version 1: messages of the server, and what clients write. Texts are JSON
/// (https://github.com/foxglove/ws-protocol/blob/main/docs/spec.md).
namespace fleetmap::monitor::foxglove {

/// The subprotocol that a WebSocket gets of those that its client offers, "a, b": the present name of this
/// protocol before its former one, which has the same messages. Empty if neither is among them.
std::string_view accepted_subprotocol(std::string_view offered);

/// A client asks for a channel's messages, which shall carry the number `id`.
struct Subscription {
  std::uint32_t id = 0, channel = 0;
};
struct Subscribe {
  std::vector<Subscription> subscriptions;
};
struct Unsubscribe {
  std::vector<std::uint32_t> ids;
};
/// An operation of the protocol that this server does not have, or none of it.
struct NotOffered {
  std::string operation;
};
using ClientRequest = std::variant<Subscribe, Unsubscribe, NotOffered>;
/// Reads a client's text. Fails with what is wrong if it is no operation.
Result<ClientRequest> parse_client_text(std::string_view text);

/// First message to each client. `session` is another one after each start of the server, so that a client
/// that connects again subscribes anew.
std::string server_info(std::string_view session);
std::string advertise(std::span<const Channel> channels);
enum class StatusLevel { info, warning, error };
std::string status(StatusLevel level, std::string_view message);

/// The header of a channel's message; its CDR follows.
std::array<std::uint8_t, 13> message_header(std::uint32_t subscription, Stamp received);

}  // namespace fleetmap::monitor::foxglove
