#include "payload.hpp"

#include <cstring>

namespace fleetmap::bus {
namespace {

using eprosima::fastrtps::rtps::SerializedPayload_t;

constexpr std::uint32_t kMaxPayloadBytes = 4u << 20;  // of a message on a radio
constexpr std::size_t kCdrHeaderBytes = 4;
constexpr std::size_t kOptions = 3;       // last byte of the header ...
constexpr std::uint8_t kPaddingBits = 3;  // ... whose two low bits count the padding at the end

}  // namespace

std::uint32_t payload_size(const Bytes& cdr) {
  return static_cast<std::uint32_t>((cdr.size() + 3u) & ~std::size_t{3});
}

bool write_payload(const Bytes& cdr, SerializedPayload_t& payload) {
  const std::size_t size = payload_size(cdr);
  if (cdr.size() < kCdrHeaderBytes || size > payload.max_size) return false;
  std::memcpy(payload.data, cdr.data(), cdr.size());
  std::memset(payload.data + cdr.size(), 0, size - cdr.size());
  payload.data[kOptions] = static_cast<std::uint8_t>((cdr[kOptions] & ~kPaddingBits) | (size - cdr.size()));
  payload.length = static_cast<std::uint32_t>(size);
  // The second byte of the header is CDR's byte order: 0 big, 1 little endian.
  payload.encapsulation = (cdr[1] & 1u) != 0 ? CDR_LE : CDR_BE;
  return true;
}

bool read_payload(const SerializedPayload_t& payload, Bytes& cdr) {
  if (payload.length < kCdrHeaderBytes) return false;
  const std::size_t padding = payload.data[kOptions] & kPaddingBits;
  if (payload.length < kCdrHeaderBytes + padding) return false;
  cdr.assign(payload.data, payload.data + payload.length - padding);
  cdr[kOptions] = static_cast<std::uint8_t>(cdr[kOptions] & ~kPaddingBits);
  return true;
}

bool PayloadPool::get_payload(std::uint32_t size, Change& change) {
  if (size > kMaxPayloadBytes) return false;  // a fragment may announce 4 GiB
  change.serializedPayload.reserve(size);
  change.payload_owner(this);
  return true;
}

bool PayloadPool::get_payload(Payload& data, IPayloadPool*& /*owner*/, Change& change) {
  if (data.length > kMaxPayloadBytes || !change.serializedPayload.copy(&data, false)) return false;
  change.payload_owner(this);
  return true;
}

bool PayloadPool::release_payload(Change& change) {
  change.serializedPayload.empty();
  change.payload_owner(nullptr);
  return true;
}

}  // namespace fleetmap::bus
