#include "raw_type.hpp"

#include "fleetmap/core/bytes.hpp"
#include "payload.hpp"

namespace fleetmap::bus {
namespace {
using eprosima::fastrtps::rtps::SerializedPayload_t;

constexpr std::uint32_t kFirstAllocation = 256;  // bytes of a new payload; it grows to what messages need

}  // namespace

RawType::RawType(const std::string& type_name) {
  setName(type_name.c_str());
  m_typeSize = kFirstAllocation;
  m_isGetKeyDefined = false;
  auto_fill_type_object(false);
  auto_fill_type_information(false);
}

bool RawType::serialize(void* data, SerializedPayload_t* payload) {
  return write_payload(*static_cast<const Bytes*>(data), *payload);
}

bool RawType::deserialize(SerializedPayload_t* payload, void* data) {
  return read_payload(*payload, *static_cast<Bytes*>(data));
}

std::function<std::uint32_t()> RawType::getSerializedSizeProvider(void* data) {
  return [data] { return payload_size(*static_cast<const Bytes*>(data)); };
}

void* RawType::createData() { return new Bytes; }
void RawType::deleteData(void* data) { delete static_cast<Bytes*>(data); }
bool RawType::getKey(void*, eprosima::fastrtps::rtps::InstanceHandle_t*, bool) { return false; }

}  // namespace fleetmap::bus
