#include "raw_type.hpp"

#include <fastdds/rtps/common/SerializedPayload.h>

#include <cstring>

#include "fleetmap/core/bytes.hpp"

namespace fleetmap::bus {
namespace {
using eprosima::fastrtps::rtps::SerializedPayload_t;

constexpr std::size_t kEncapsulation = 4;
constexpr std::size_t kOptions = 3;  // last byte of the header; its two low bits count the padding at the end
constexpr std::uint8_t kPaddingBits = 3;         // (DDS-XTypes 1.3, 7.6.3.1.2)
constexpr std::uint32_t kFirstAllocation = 256;  // bytes of a new payload; it grows to what messages need
/// RTPS fills a message up to a multiple of 4. Fast DDS does so without saying how much, and the receiver
/// would get bytes that nobody sent; so it is done here, and said.
std::size_t padded(std::size_t size) { return (size + 3u) & ~std::size_t{3}; }

}  // namespace

RawType::RawType(const std::string& type_name) {
  setName(type_name.c_str());
  m_typeSize = kFirstAllocation;
  m_isGetKeyDefined = false;
  auto_fill_type_object(false);
  auto_fill_type_information(false);
}

bool RawType::serialize(void* data, SerializedPayload_t* payload) {
  const Bytes& cdr = *static_cast<const Bytes*>(data);
  const std::size_t size = padded(cdr.size());
  if (cdr.size() < kEncapsulation || size > payload->max_size) return false;
  std::memcpy(payload->data, cdr.data(), cdr.size());
  std::memset(payload->data + cdr.size(), 0, size - cdr.size());
  payload->data[kOptions] = static_cast<std::uint8_t>((cdr[kOptions] & ~kPaddingBits) | (size - cdr.size()));
  payload->length = static_cast<std::uint32_t>(size);
  // The second byte of the header tells CDR's byte order: 0 big, 1 little endian.
  payload->encapsulation = (cdr[1] & 1u) != 0 ? CDR_LE : CDR_BE;
  return true;
}

bool RawType::deserialize(SerializedPayload_t* payload, void* data) {
  if (payload->length < kEncapsulation) return false;
  const std::size_t padding = payload->data[kOptions] & kPaddingBits;
  if (payload->length < kEncapsulation + padding) return false;
  Bytes& cdr = *static_cast<Bytes*>(data);
  cdr.assign(payload->data, payload->data + payload->length - padding);
  cdr[kOptions] = static_cast<std::uint8_t>(cdr[kOptions] & ~kPaddingBits);
  return true;
}

std::function<std::uint32_t()> RawType::getSerializedSizeProvider(void* data) {
  return [data] { return static_cast<std::uint32_t>(padded(static_cast<const Bytes*>(data)->size())); };
}

void* RawType::createData() { return new Bytes; }
void RawType::deleteData(void* data) { delete static_cast<Bytes*>(data); }
bool RawType::getKey(void*, eprosima::fastrtps::rtps::InstanceHandle_t*, bool) { return false; }

}  // namespace fleetmap::bus
