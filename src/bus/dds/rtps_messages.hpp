#pragma once

#include <fastdds/rtps/attributes/HistoryAttributes.h>
#include <fastdds/rtps/common/Locator.h>
#include <fastdds/rtps/common/Time_t.h>
#include <fastdds/rtps/history/WriterHistory.h>
#include <fastdds/rtps/reader/RTPSReader.h>
#include <fastdds/rtps/writer/RTPSWriter.h>

#include <cstddef>
#include <cstdint>
#include <fastdds/dds/core/policy/QosPolicies.hpp>
#include <fastdds/rtps/common/EntityId_t.hpp>
#include <optional>
#include <string>

#include "fleetmap/bus/bus.hpp"
#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/time.hpp"

/// The parts of Fast DDS's RTPS layer that radio links need.
namespace fleetmap::bus {

/// Entity ids of the writers of Hellos; those of topics lie below.
inline constexpr std::uint32_t kHelloWriters = 0xff0000;

eprosima::fastrtps::rtps::EntityId_t writer_id(std::uint32_t key);
std::uint32_t key_of(const eprosima::fastrtps::rtps::EntityId_t& id);
/// The same on every robot.
std::uint32_t key_of(const Topic& topic);

/// "10.0.0.2:7660".
std::string to_text(const eprosima::fastrtps::rtps::Locator_t& locator);

/// Sends one change; a full history drops its content. False: refused.
bool send(eprosima::fastrtps::rtps::RTPSWriter& writer, eprosima::fastrtps::rtps::WriterHistory& history,
          const Bytes& cdr, std::size_t depth);
/// Takes a change out of its reader's history; empty for what is no message.
std::optional<Bytes> taken(eprosima::fastrtps::rtps::RTPSReader& reader,
                           const eprosima::fastrtps::rtps::CacheChange_t* change);
/// By the clocks of the machine that set the stamp and of this one. Empty if the message carries no stamp, or
/// one that no clock can have, since a forged message may contain any.
std::optional<Duration> since(const eprosima::fastrtps::rtps::Time_t& stamp);

eprosima::fastrtps::rtps::HistoryAttributes unbounded_history();

/// Attributes that all endpoints on radios share.
template <class Attributes>
Attributes best_effort() {
  Attributes attributes;
  attributes.endpoint.reliabilityKind = eprosima::fastrtps::rtps::BEST_EFFORT;
  attributes.endpoint.durabilityKind = eprosima::fastrtps::rtps::VOLATILE;
  attributes.endpoint.topicKind = eprosima::fastrtps::rtps::NO_KEY;
  eprosima::fastdds::dds::DataSharingQosPolicy off;
  off.off();
  attributes.endpoint.set_data_sharing_configuration(off);
  return attributes;
}

}  // namespace fleetmap::bus
