#pragma once

#include <fastdds/rtps/common/CacheChange.h>
#include <fastdds/rtps/history/IPayloadPool.h>

#include "fleetmap/core/bytes.hpp"

namespace fleetmap::bus {

/// The size of `cdr` as a payload: RTPS pads it to a multiple of 4. Fast DDS does not report how much it
/// padded, and the receiver would get bytes that were never sent; so the padding is done here and noted in
/// the encapsulation header (DDS-XTypes 1.3, 7.6.3.1.2).
std::uint32_t payload_size(const Bytes& cdr);
/// False if it has no encapsulation header or does not fit.
bool write_payload(const Bytes& cdr, eprosima::fastrtps::rtps::SerializedPayload_t& payload);
/// False for what is no message.
bool read_payload(const eprosima::fastrtps::rtps::SerializedPayload_t& payload, Bytes& cdr);

/// Memory of payloads, each allocated for itself. RTPS endpoints with a chosen entity id need a pool that is
/// given to them, and Fast DDS keeps its own ones to itself.
class PayloadPool final : public eprosima::fastrtps::rtps::IPayloadPool {
 public:
  using Change = eprosima::fastrtps::rtps::CacheChange_t;
  using Payload = eprosima::fastrtps::rtps::SerializedPayload_t;
  bool get_payload(std::uint32_t size, Change& change) override;
  bool get_payload(Payload& data, IPayloadPool*& owner, Change& change) override;
  bool release_payload(Change& change) override;
};

}  // namespace fleetmap::bus
