#include "fleetmap/fleet_codec/short_range.hpp"

#include "fields.hpp"
#include "fleetmap/fleet_codec/bounds.hpp"
#include "fleetmap_short_range.h"
#include "schema.hpp"
#include "type_names.hpp"

namespace fleetmap::fleet_codec {

Bytes encode(const messages::SubmapDigest& digest) {
  msg::SubmapDigest out;
  out.schema(kSchemaVersion);
  out.sender(agent_name(digest.from));
  out.submaps(ranges(digest.submaps, kMaxSubmapRanges));
  for (std::size_t k = 0; k < std::min(digest.hears.size(), kMaxHeard); ++k)
    out.hears().push_back(agent_name(digest.hears[k]));
  return bus::to_cdr(out);
}

template <>
Result<messages::SubmapDigest> decode(ByteView cdr) {
  const auto in = fleet_type_from_cdr<msg::SubmapDigest>(cdr, type_name::kSubmapDigest);
  if (!in) return tl::unexpected(in.error());
  FieldCheck check(type_name::kSubmapDigest);
  messages::SubmapDigest digest;
  digest.from = check.agent(in->sender(), "sender");
  digest.submaps = check.ranges(in->submaps(), kMaxSubmapRanges, "submaps");
  check.require(in->hears().size() <= kMaxHeard, "hears: more than 255 agents");
  for (std::size_t k = 0; k < std::min(in->hears().size(), kMaxHeard); ++k)
    digest.hears.push_back(check.agent(in->hears()[k], "hears"));
  return check.finish(std::move(digest));
}

Bytes encode(const messages::SubmapRequest& request) {
  msg::SubmapRequest out;
  out.schema(kSchemaVersion);
  out.sender(agent_name(request.from));
  out.recipient(agent_name(request.to));
  out.node(node_ref(request.node));
  out.offset(request.offset);
  out.length(request.length);
  return bus::to_cdr(out);
}

template <>
Result<messages::SubmapRequest> decode(ByteView cdr) {
  const auto in = fleet_type_from_cdr<msg::SubmapRequest>(cdr, type_name::kSubmapRequest);
  if (!in) return tl::unexpected(in.error());
  FieldCheck check(type_name::kSubmapRequest);
  messages::SubmapRequest request;
  request.from = check.agent(in->sender(), "sender");
  request.to = check.agent(in->recipient(), "recipient");
  request.node = check.node(in->node(), "node");
  request.offset = in->offset();
  request.length = in->length();
  check.require(request.offset <= kMaxSubmapBytes && request.length <= kMaxSubmapBytes - request.offset,
                "offset + length is beyond 64 MiB");
  return check.finish(request);
}

Bytes encode(const messages::SubmapChunk& chunk) {
  msg::SubmapChunk out;
  out.schema(kSchemaVersion);
  out.sender(agent_name(chunk.from));
  out.recipient(agent_name(chunk.to));
  out.node(node_ref(chunk.node));
  out.offset(chunk.offset);
  out.total_bytes(chunk.total_bytes);
  out.payload(bounded(chunk.payload, messages::SubmapChunk::kMaxPayload));
  return bus::to_cdr(out);
}

template <>
Result<messages::SubmapChunk> decode(ByteView cdr) {
  auto in = fleet_type_from_cdr<msg::SubmapChunk>(cdr, type_name::kSubmapChunk);
  if (!in) return tl::unexpected(in.error());
  FieldCheck check(type_name::kSubmapChunk);
  messages::SubmapChunk chunk;
  chunk.from = check.agent(in->sender(), "sender");
  chunk.to = check.agent(in->recipient(), "recipient");
  chunk.node = check.node(in->node(), "node");
  chunk.offset = in->offset();
  chunk.total_bytes = in->total_bytes();
  check.require(in->payload().size() <= messages::SubmapChunk::kMaxPayload, "payload is beyond 8192 bytes");
  check.require(chunk.total_bytes <= kMaxSubmapBytes, "total_bytes is beyond 64 MiB");
  check.require(chunk.offset <= chunk.total_bytes && in->payload().size() <= chunk.total_bytes - chunk.offset,
                "the chunk reaches beyond total_bytes");
  chunk.payload = std::move(in->payload());
  return check.finish(std::move(chunk));
}

}  // namespace fleetmap::fleet_codec
