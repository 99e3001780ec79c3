#pragma once

#include <fastdds/rtps/attributes/RTPSParticipantAttributes.h>

#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>
#include <string>
#include <vector>

#include "fleetmap/bus/dds_bus.hpp"
#include "fleetmap/core/result.hpp"
#include "qos_file.hpp"

namespace fleetmap::bus {

Status validate(const DdsLinkConfig& config, const std::string& link);

/// Fails unless an interface of this machine that is up has `config.address`. Fast DDS would make a
/// participant without any connection and report this in its log only.
Status check_address(const DdsLinkConfig& config, const std::string& link);

/// The participant profile of a link's file.
Result<eprosima::fastdds::dds::DomainParticipantQos> participant_profile(const QosFile& file, Link link);

/// Puts a run's settings (own address, peers, name, shared memory or not) on top of the onboard profile.
void apply_onboard(const DdsLinkConfig& config, const AgentId& agent,
                   eprosima::fastdds::dds::DomainParticipantQos& qos);

/// A participant on a radio: the profile's transports on the own address, and no discovery. An observer
/// leaves the first port to the robot.
eprosima::fastrtps::rtps::RTPSParticipantAttributes radio_attributes(
    const DdsLinkConfig& config, Link link, const AgentId& agent, bool observes,
    const eprosima::fastdds::dds::DomainParticipantQos& qos);
/// The DDS domain that a port belongs to.
std::uint32_t domain_of(std::uint32_t port, const eprosima::fastdds::dds::DomainParticipantQos& qos);
/// The address that a robot has on a radio: the loopback where none is set.
std::string own_address(const DdsLinkConfig& config);
/// Addresses at which others may listen: the ports of each peer that `config` names, and of this machine if
/// it names none.
std::vector<eprosima::fastrtps::rtps::Locator_t> listening_places(
    const DdsLinkConfig& config, const eprosima::fastdds::dds::DomainParticipantQos& qos);

/// Size of the segment that a participant would make; 0 without shared memory.
std::size_t shared_memory_bytes(const eprosima::fastdds::dds::DomainParticipantQos& qos);
void leave_out_shared_memory(eprosima::fastdds::dds::DomainParticipantQos& qos);

}  // namespace fleetmap::bus
