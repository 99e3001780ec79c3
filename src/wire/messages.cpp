#include "fleetmap/wire/messages.hpp"

#include "type_names.hpp"

namespace fleetmap::wire {
namespace {

template <class T>
Result<exchange::Message> decode_as(ByteView cdr) {
  auto message = decode<T>(cdr);
  if (!message) return tl::unexpected(message.error());
  return exchange::Message(std::move(*message));
}

}  // namespace

Bytes encode(const exchange::Message& message) {
  return std::visit([](const auto& m) { return encode(m); }, message);
}

Result<exchange::Message> decode_message(const bus::Topic& topic, ByteView cdr) {
  const std::string& type = topic.type;
  if (type == type_name::kNode) return decode_as<graph::Node>(cdr);
  if (type == type_name::kAlignment) return decode_as<graph::Alignment>(cdr);
  if (type == type_name::kProximityMatch) return decode_as<exchange::ProximityMatch>(cdr);
  if (type == type_name::kCloudFragment) return decode_as<exchange::CloudFragment>(cdr);
  if (type == type_name::kCloudRequest) return decode_as<exchange::CloudRequest>(cdr);
  if (type == type_name::kDigest) return decode_as<exchange::Digest>(cdr);
  if (type == type_name::kItemRequest) return decode_as<exchange::ItemRequest>(cdr);
  if (type == type_name::kAgentStatus) return decode_as<exchange::AgentStatus>(cdr);
  if (type == type_name::kMissionReport) return decode_as<exchange::MissionReport>(cdr);
  if (type == type_name::kHold) return decode_as<exchange::Hold>(cdr);
  if (type == type_name::kSubmapDigest) return decode_as<exchange::SubmapDigest>(cdr);
  if (type == type_name::kSubmapRequest) return decode_as<exchange::SubmapRequest>(cdr);
  if (type == type_name::kSubmapChunk) return decode_as<exchange::SubmapChunk>(cdr);
  return failure("topic '" + topic.name + "': type '" + type + "' is not a message between agents");
}

}  // namespace fleetmap::wire
