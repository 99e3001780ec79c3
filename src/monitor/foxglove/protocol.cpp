#include "protocol.hpp"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "schemas.hpp"

namespace fleetmap::monitor::foxglove {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 2> kSubprotocols = {"foxglove.sdk.v1", "foxglove.websocket.v1"};
constexpr std::size_t kMaxOperationShown = 40;  // characters
constexpr std::uint8_t kMessageData = 1;

bool offers(std::string_view offered, std::string_view wanted) {
  while (!offered.empty()) {
    const std::size_t end = std::min(offered.find(','), offered.size());
    std::string_view one = offered.substr(0, end);
    offered.remove_prefix(std::min(end + 1, offered.size()));
    one.remove_prefix(std::min(one.find_first_not_of(" \t"), one.size()));
    one = one.substr(0, one.find_last_not_of(" \t") + 1);
    if (one == wanted) return true;
  }
  return false;
}

std::string dumped(const json& message) {
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::optional<std::uint32_t> number_of(const json& value) {
  if (!value.is_number_unsigned()) return std::nullopt;
  const auto number = value.get<std::uint64_t>();
  if (number > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
  return static_cast<std::uint32_t>(number);
}

std::optional<std::uint32_t> number_in(const json& object, const char* name) {
  if (!object.is_object()) return std::nullopt;
  const auto found = object.find(name);
  return found == object.end() ? std::nullopt : number_of(*found);
}

Result<ClientRequest> parse_subscribe(const json& message) {
  const auto failed = failure(
      "subscribe: expected `subscriptions`, a list of {id, channelId} that are whole "
      "numbers of 0 to 4294967295");
  const auto list = message.find("subscriptions");
  if (list == message.end() || !list->is_array()) return failed;
  Subscribe request;
  for (const json& one : *list) {
    const auto id = number_in(one, "id"), channel = number_in(one, "channelId");
    if (!id || !channel) return failed;
    request.subscriptions.push_back({*id, *channel});
  }
  return request;
}

Result<ClientRequest> parse_unsubscribe(const json& message) {
  const auto failed = failure(
      "unsubscribe: expected `subscriptionIds`, a list of whole numbers of 0 to "
      "4294967295");
  const auto list = message.find("subscriptionIds");
  if (list == message.end() || !list->is_array()) return failed;
  Unsubscribe request;
  for (const json& one : *list) {
    const auto id = number_of(one);
    if (!id) return failed;
    request.ids.push_back(*id);
  }
  return request;
}

}  // namespace

std::string_view accepted_subprotocol(std::string_view offered) {
  for (const std::string_view name : kSubprotocols) {
    if (offers(offered, name)) return name;
  }
  return {};
}

Result<ClientRequest> parse_client_text(std::string_view text) {
  const json message = json::parse(text, nullptr, false);
  if (!message.is_object()) return failure("a text that is no JSON object was ignored");
  const auto operation = message.find("op");
  if (operation == message.end() || !operation->is_string())
    return failure("a text without the name of an operation, `op`, was ignored");
  const auto& name = operation->get_ref<const std::string&>();
  if (name == "subscribe") return parse_subscribe(message);
  if (name == "unsubscribe") return parse_unsubscribe(message);
  return NotOffered{name.substr(0, kMaxOperationShown)};
}

std::string server_info(std::string_view session) {
  return dumped({{"op", "serverInfo"},
                 {"name", "fleetmap monitor"},
                 {"capabilities", json::array()},
                 {"sessionId", session}});
}

std::string advertise(std::span<const Channel> channels) {
  json list = json::array();
  for (const Channel& channel : channels) {
    const Schema& schema = schema_of(channel.kind);
    list.push_back({{"id", channel.id},
                    {"topic", channel.topic},
                    {"encoding", "cdr"},
                    {"schemaName", schema.name},
                    {"schema", schema.idl},
                    {"schemaEncoding", "omgidl"}});
  }
  return dumped({{"op", "advertise"}, {"channels", std::move(list)}});
}

std::string status(StatusLevel level, std::string_view message) {
  return dumped({{"op", "status"}, {"level", static_cast<int>(level)}, {"message", message}});
}

std::array<std::uint8_t, 13> message_header(std::uint32_t subscription, Stamp received) {
  std::array<std::uint8_t, 13> header{kMessageData};
  const auto ns = static_cast<std::uint64_t>(to_ns(received));
  for (unsigned k = 0; k < 4; ++k) header[1 + k] = static_cast<std::uint8_t>(subscription >> 8 * k);
  for (unsigned k = 0; k < 8; ++k) header[5 + k] = static_cast<std::uint8_t>(ns >> 8 * k);
  return header;
}

}  // namespace fleetmap::monitor::foxglove
