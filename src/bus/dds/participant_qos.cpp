#include "participant_qos.hpp"

#include <arpa/inet.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <memory>
#include <optional>
#include <random>

#include "fleetmap/core/text_list.hpp"

namespace fleetmap::bus {
namespace {

using eprosima::fastdds::rtps::SharedMemTransportDescriptor;
using eprosima::fastdds::rtps::UDPv4TransportDescriptor;
using eprosima::fastrtps::rtps::IPLocator;
using eprosima::fastrtps::rtps::Locator_t;
using eprosima::fastrtps::rtps::PortParameters;

constexpr const char* kLoopback = "127.0.0.1";
constexpr std::uint32_t kMaxDomain = 230;  // ports above are beyond 65535, where Fast DDS ends the process

bool is_ipv4(const std::string& text) {
  in_addr address{};
  return inet_pton(AF_INET, text.c_str(), &address) == 1;
}

constexpr const char* kDiscoveryGroup = "239.255.0.1";  // RTPS 2.2, 9.6.1.4.1
constexpr std::uint32_t kParticipantsHere = 16;         // sought on this machine
constexpr std::uint32_t kParticipantsElsewhere = 4;     // on it, in other domains

struct Peer {
  std::string address;
  std::uint16_t port = 0;  ///< 0: the well-known ports of the domain
};

std::optional<Peer> parse_peer(const std::string& text) {
  const auto colon = text.find(':');
  Peer peer{text.substr(0, colon)};
  if (!is_ipv4(peer.address)) return std::nullopt;
  if (colon == std::string::npos) return peer;
  const char* first = text.data() + colon + 1;
  const auto [end, error] = std::from_chars(first, text.data() + text.size(), peer.port);
  if (error != std::errc{} || end != text.data() + text.size() || peer.port == 0) return std::nullopt;
  return peer;
}

Locator_t to_locator(const Peer& peer) {
  Locator_t locator;
  locator.kind = LOCATOR_KIND_UDPv4;
  IPLocator::setIPv4(locator, peer.address);
  locator.port = peer.port;
  return locator;
}

/// Fast DDS derives a participant's port in shared memory from its number, and numbers those of a process
/// from 0. A process that restarts after it was killed would get the port of the dead one, to which writers
/// continue to write though it is no longer read (Fast DDS 2.9.1; docs/reference/dds.md). So each start takes
/// other numbers; UDP's discovery ports are named and stay.
int unused_number() {
  static std::atomic<unsigned> next = std::random_device()();
  constexpr unsigned kFirst = 16;
  constexpr unsigned kNumbers = 100;  // ports of the domain above would start at 120
  return static_cast<int>(kFirst + next++ % kNumbers);
}

std::uint16_t first_port(std::uint32_t domain, const PortParameters& ports) {
  return static_cast<std::uint16_t>(ports.getUnicastPort(domain, 0));
}

/// `count` participants at `first` and the ports after.
void add_places(const Peer& first, std::uint32_t count, const PortParameters& ports,
                std::vector<Locator_t>& places) {
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t port = first.port + i * ports.participantIDGain;
    places.push_back(to_locator({first.address, static_cast<std::uint16_t>(port)}));
  }
}

/// All peers, each with the ports that its participants may use.
std::vector<Locator_t> places_of(const DdsLinkConfig& config, const std::string& own,
                                 const PortParameters& ports) {
  std::vector<Locator_t> places;
  for (const std::string& text : config.peers.empty() ? std::vector{own} : config.peers) {
    Peer peer = *parse_peer(text);
    const bool here = peer.address == own || peer.address.starts_with("127.");
    const std::uint32_t several = here ? kParticipantsHere : 1;
    const std::uint32_t count = peer.port != 0                      ? 1
                                : config.participants_per_peer != 0 ? config.participants_per_peer
                                                                    : several;
    if (peer.port == 0) peer.port = first_port(config.domain, ports);
    add_places(peer, count, ports, places);
    for (const std::uint32_t domain : config.other_domains) {
      if (domain == config.domain) continue;
      add_places({peer.address, first_port(domain, ports)}, here ? kParticipantsElsewhere : 1, ports, places);
    }
  }
  return places;
}

using Transports = std::vector<std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface>>;

/// Copies, since every participant of a profile in the process gets the same descriptors.
void restrict_to(const std::string& address, Transports& transports) {
  for (auto& transport : transports) {
    const auto udp = std::dynamic_pointer_cast<UDPv4TransportDescriptor>(transport);
    if (!udp) continue;
    const auto copy = std::make_shared<UDPv4TransportDescriptor>(*udp);
    copy->interfaceWhiteList = {address};
    transport = copy;
  }
}

std::string participant_name(const AgentId& agent, Link link) {
  return "fleetmap/" + agent.str() + "/" + to_string(link);
}

}  // namespace

namespace {

using Interfaces = std::unique_ptr<ifaddrs, decltype(&freeifaddrs)>;

/// Empty where they cannot be listed.
Interfaces interfaces() {
  ifaddrs* found = nullptr;
  return {getifaddrs(&found) == 0 ? found : nullptr, &freeifaddrs};
}

/// "eth0 10.0.0.1, wlan0 192.168.1.4"
std::string names_of(const Interfaces& all) {
  std::string names;
  for (const auto* entry = all.get(); entry != nullptr; entry = entry->ifa_next) {
    if (entry->ifa_addr == nullptr || entry->ifa_addr->sa_family != AF_INET) continue;
    char text[INET_ADDRSTRLEN] = "";
    inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(entry->ifa_addr)->sin_addr, text, sizeof text);
    append_to_list(names, std::string(entry->ifa_name) + " " + text);
  }
  return names.empty() ? "none" : names;
}

}  // namespace

Status validate(const DdsLinkConfig& config, const std::string& link) {
  const auto wrong = [&](const std::string& what) { return failure(link + "." + what); };
  if (config.domain > kMaxDomain) {
    return wrong("domain is " + std::to_string(config.domain) + "; must be in [0, 230]");
  }
  if (!config.address.empty() && !is_ipv4(config.address)) {
    return wrong("address is \"" + config.address + "\"; must be an IPv4 address of this machine, or empty");
  }
  for (const std::uint32_t domain : config.other_domains) {
    if (domain > kMaxDomain) return wrong("other_domains has " + std::to_string(domain) + "; at most 230");
  }
  for (const std::string& peer : config.peers) {
    if (!parse_peer(peer)) return wrong("peers has \"" + peer + "\"; must be ADDRESS or ADDRESS:PORT, IPv4");
  }
  const bool radio = link != to_string(Link::kOnboard);
  const auto elsewhere = [](const std::string& peer) { return !peer.starts_with("127."); };
  if (const auto peer = std::ranges::find_if(config.peers, elsewhere);
      radio && config.address.empty() && peer != config.peers.end()) {
    return wrong("address is not set, but " + *peer +
                 " is another machine: give this robot's own address on " + "that radio; this machine has " +
                 names_of(interfaces()));
  }
  if (!(config.fleet_bits_per_second > 0.0)) return wrong("fleet_bits_per_second must be > 0");
  if (config.queue_messages == 0) return wrong("queue_messages must be > 0");
  if (config.queue_bytes == 0) return wrong("queue_bytes must be > 0");
  return {};
}

Status check_address(const DdsLinkConfig& config, const std::string& link) {
  if (config.address.empty()) return {};
  in_addr wanted{};
  inet_pton(AF_INET, config.address.c_str(), &wanted);
  const Interfaces all = interfaces();
  for (const auto* entry = all.get(); entry; entry = entry->ifa_next) {
    if (!entry->ifa_addr || entry->ifa_addr->sa_family != AF_INET) continue;
    const auto* own = reinterpret_cast<const sockaddr_in*>(entry->ifa_addr);
    const bool running = (entry->ifa_flags & IFF_RUNNING) != 0;
    if (own->sin_addr.s_addr != wanted.s_addr) continue;
    if (running) return {};
    return failure(link + ".address: the interface " + entry->ifa_name + " of " + config.address +
                   " is down; bring it up or disable the link");
  }
  return failure(link + ".address: no interface of this machine has " + config.address + " (it has " +
                 names_of(all) + "); correct it or disable the link");
}

std::size_t shared_memory_bytes(const eprosima::fastdds::dds::DomainParticipantQos& qos) {
  for (const auto& transport : qos.transport().user_transports) {
    if (const auto shared = std::dynamic_pointer_cast<SharedMemTransportDescriptor>(transport))
      return shared->segment_size();
  }
  return 0;
}

void leave_out_shared_memory(eprosima::fastdds::dds::DomainParticipantQos& qos) {
  std::erase_if(qos.transport().user_transports, [](const auto& transport) {
    return std::dynamic_pointer_cast<SharedMemTransportDescriptor>(transport) != nullptr;
  });
}

Result<eprosima::fastdds::dds::DomainParticipantQos> participant_profile(const QosFile& file, Link link) {
  eprosima::fastdds::dds::DomainParticipantQos qos;
  auto* factory = eprosima::fastdds::dds::DomainParticipantFactory::get_instance();
  if (factory->get_participant_qos_from_profile(file.registered(to_string(link)), qos) ==
      eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK)
    return qos;
  return failure(file.path.string() + ": Fast DDS does not know the participant profile \"" +
                 to_string(link) + "\" after loading it; its log says why");
}

/// Fast DDS numbers the participants of a process, whatever their domain, and derives ports from the number.
/// With ports given, the first participant of a domain on a machine is always at the first port of that
/// domain, the next one at the port after (Fast DDS moves on while one is taken), and so on. Naming them also
/// turns multicast off, but for what is named: so that ROS 2 nodes on this machine find this robot.
void apply_onboard(const DdsLinkConfig& config, const AgentId& agent,
                   eprosima::fastdds::dds::DomainParticipantQos& qos) {
  const std::string own = own_address(config);
  qos.name(participant_name(agent, Link::kOnboard));
  if (!config.shared_memory) leave_out_shared_memory(qos);
  restrict_to(own, qos.transport().user_transports);
  auto& wire = qos.wire_protocol();
  auto& unicast = wire.builtin.metatrafficUnicastLocatorList;
  unicast.clear();
  unicast.push_back(to_locator({"0.0.0.0", first_port(config.domain, wire.port)}));
  const Locator_t group =
      to_locator({kDiscoveryGroup, static_cast<std::uint16_t>(wire.port.getMulticastPort(config.domain))});
  wire.builtin.metatrafficMulticastLocatorList.push_back(group);
  wire.participant_id = unused_number();
  auto& known = wire.builtin.initialPeersList;
  if (config.peers.empty() && !known.empty()) return;
  known.clear();
  for (const Locator_t& place : places_of(config, own, wire.port)) known.push_back(place);
  known.push_back(group);
}

std::string own_address(const DdsLinkConfig& config) {
  return config.address.empty() ? kLoopback : config.address;
}

eprosima::fastrtps::rtps::RTPSParticipantAttributes radio_attributes(
    const DdsLinkConfig& config, Link link, const AgentId& agent, bool observes,
    const eprosima::fastdds::dds::DomainParticipantQos& qos) {
  eprosima::fastrtps::rtps::RTPSParticipantAttributes attributes;
  attributes.setName(participant_name(agent, link).c_str());
  attributes.participantID = unused_number();
  attributes.port = qos.wire_protocol().port;
  attributes.builtin.discovery_config.discoveryProtocol = eprosima::fastrtps::rtps::DiscoveryProtocol_t::NONE;
  attributes.builtin.use_WriterLivelinessProtocol = false;
  attributes.useBuiltinTransports = false;
  attributes.userTransports = qos.transport().user_transports;
  restrict_to(own_address(config), attributes.userTransports);
  const int port =
      first_port(config.domain, attributes.port) + (observes ? attributes.port.participantIDGain : 0);
  attributes.defaultUnicastLocatorList.push_back(to_locator({"0.0.0.0", static_cast<std::uint16_t>(port)}));
  return attributes;
}

std::uint32_t domain_of(std::uint32_t port, const eprosima::fastdds::dds::DomainParticipantQos& qos) {
  const auto& ports = qos.wire_protocol().port;
  const std::uint32_t first = ports.getUnicastPort(0, 0);
  return port < first || ports.domainIDGain == 0 ? 0 : (port - first) / ports.domainIDGain;
}

std::vector<Locator_t> listening_places(const DdsLinkConfig& config,
                                        const eprosima::fastdds::dds::DomainParticipantQos& qos) {
  return places_of(config, own_address(config), qos.wire_protocol().port);
}

}  // namespace fleetmap::bus
