#include "participant_qos.hpp"

#include <arpa/inet.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

#include <charconv>
#include <memory>
#include <optional>

namespace fleetmap::bus {
namespace {

using eprosima::fastdds::rtps::SharedMemTransportDescriptor;
using eprosima::fastdds::rtps::UDPv4TransportDescriptor;
using eprosima::fastrtps::rtps::IPLocator;
using eprosima::fastrtps::rtps::Locator_t;

constexpr const char* kLoopback = "127.0.0.1";
constexpr std::uint32_t kMaxDomain = 230;  // ports above are beyond 65535, where Fast DDS ends the process

bool is_ipv4(const std::string& text) {
  in_addr address{};
  return inet_pton(AF_INET, text.c_str(), &address) == 1;
}

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

}  // namespace

Status validate(const DdsLinkConfig& config, const std::string& link) {
  const auto wrong = [&](const std::string& what) { return failure(link + "." + what); };
  if (config.domain > kMaxDomain) {
    return wrong("domain is " + std::to_string(config.domain) + "; must be in [0, 230]");
  }
  if (!config.address.empty() && !is_ipv4(config.address)) {
    return wrong("address is \"" + config.address + "\"; must be an IPv4 address of this machine, or empty");
  }
  for (const std::string& peer : config.peers) {
    if (!parse_peer(peer)) return wrong("peers has \"" + peer + "\"; must be ADDRESS or ADDRESS:PORT, IPv4");
  }
  if (config.queue_messages == 0) return wrong("queue_messages must be > 0");
  if (config.queue_bytes == 0) return wrong("queue_bytes must be > 0");
  return {};
}

void apply(const DdsLinkConfig& config, Link link, const AgentId& agent,
           eprosima::fastdds::dds::DomainParticipantQos& qos) {
  qos.name("fleetmap/" + agent.str() + "/" + to_string(link));

  std::string own = config.address;
  if (own.empty() && link == Link::kOnboard) own = kLoopback;
  auto& transports = qos.transport().user_transports;
  if (!config.shared_memory) {
    std::erase_if(transports, [](const auto& transport) {
      return std::dynamic_pointer_cast<SharedMemTransportDescriptor>(transport) != nullptr;
    });
  }
  for (auto& transport : transports) {
    const auto udp = std::dynamic_pointer_cast<UDPv4TransportDescriptor>(transport);
    if (!udp) continue;
    // A copy, since every participant of this profile in the process gets the same descriptor.
    const auto copy = std::make_shared<UDPv4TransportDescriptor>(*udp);
    if (!own.empty()) copy->interfaceWhiteList = {own};
    if (config.participants_per_peer > 0) copy->maxInitialPeersRange = config.participants_per_peer;
    transport = copy;
  }

  auto& known = qos.wire_protocol().builtin.initialPeersList;
  if (!config.peers.empty()) known.clear();
  for (const std::string& peer : config.peers) known.push_back(to_locator(*parse_peer(peer)));
  // Without any initial peer Fast DDS would announce itself by multicast.
  if (known.empty()) known.push_back(to_locator({own.empty() ? kLoopback : own}));
}

}  // namespace fleetmap::bus
