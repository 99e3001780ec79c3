#include "fleetmap/fleet_codec/messages.hpp"

#include "type_names.hpp"

namespace fleetmap::fleet_codec {
namespace {

template <class T>
Result<messages::Message> decode_as(ByteView cdr) {
  auto message = decode<T>(cdr);
  if (!message) return tl::unexpected(message.error());
  return messages::Message(std::move(*message));
}

}  // namespace

Bytes encode(const messages::Message& message) {
  return std::visit([](const auto& m) { return encode(m); }, message);
}

Result<messages::Message> decode_message(const bus::Topic& topic, ByteView cdr) {
  const std::string& type = topic.type;
  if (type == type_name::kNode) return decode_as<graph::Node>(cdr);
  if (type == type_name::kAlignment) return decode_as<graph::Alignment>(cdr);
  if (type == type_name::kProximityMatch) return decode_as<messages::ProximityMatch>(cdr);
  if (type == type_name::kCloudFragment) return decode_as<messages::CloudFragment>(cdr);
  if (type == type_name::kCloudRequest) return decode_as<messages::CloudRequest>(cdr);
  if (type == type_name::kDigest) return decode_as<messages::Digest>(cdr);
  if (type == type_name::kItemRequest) return decode_as<messages::ItemRequest>(cdr);
  if (type == type_name::kAgentStatus) return decode_as<messages::AgentStatus>(cdr);
  if (type == type_name::kMissionReport) return decode_as<messages::MissionReport>(cdr);
  if (type == type_name::kHold) return decode_as<messages::Hold>(cdr);
  if (type == type_name::kSubmapDigest) return decode_as<messages::SubmapDigest>(cdr);
  if (type == type_name::kSubmapRequest) return decode_as<messages::SubmapRequest>(cdr);
  if (type == type_name::kSubmapChunk) return decode_as<messages::SubmapChunk>(cdr);
  return failure("topic '" + topic.name + "': type '" + type + "' is not a message between agents");
}

}  // namespace fleetmap::fleet_codec
