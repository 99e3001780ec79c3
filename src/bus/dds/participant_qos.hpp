#pragma once

#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>
#include <string>

#include "fleetmap/bus/dds_bus.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::bus {

Status validate(const DdsLinkConfig& config, const std::string& link);

/// Fails unless an interface of this machine that is up has `config.address`. Fast DDS would make a
/// participant that reaches nobody and say so in its log only.
Status check_address(const DdsLinkConfig& config, const std::string& link);

/// Puts a run's settings (own address, peers, name, shared memory or not) on top of a participant profile.
void apply(const DdsLinkConfig& config, Link link, const AgentId& agent,
           eprosima::fastdds::dds::DomainParticipantQos& qos);

/// Size of the segment that a participant would make; 0 without shared memory.
std::size_t shared_memory_bytes(const eprosima::fastdds::dds::DomainParticipantQos& qos);
void leave_out_shared_memory(eprosima::fastdds::dds::DomainParticipantQos& qos);

}  // namespace fleetmap::bus
