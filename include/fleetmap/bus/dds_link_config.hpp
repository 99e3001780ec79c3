#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace fleetmap::bus {

/// Settings of one link that differ from run to run; all others are policy and live in qos/<link>.xml.
struct DdsLinkConfig {
  bool enabled = true;       ///< a link that is not: publishing counts as dropped, subscribing is silent
  std::uint32_t domain = 0;  ///< DDS domain id in [0, 230]
  /// IPv4 address of the own interface to use, and no other. Empty: the loopback onboard, every interface on
  /// radios.
  std::string address = {};
  /// Addresses of possible peers: "10.0.0.2" or "10.0.0.2:7412", a port being that of discovery
  /// (docs/reference/dds.md). Empty: those of the profile, or else this machine. Onboard the loopback's
  /// multicast group is always included.
  std::vector<std::string> peers = {};
  std::uint32_t participants_per_peer =
      0;  ///< number of participant ids to try on a peer; 0: that of the profile
  /// On radios: what is for all goes out once, to a multicast group; false: a datagram for each robot. All
  /// robots must have it alike, and the medium must carry multicast between them.
  bool multicast = false;
  /// On radios: further DDS domains at whose ports peers are sought, at the addresses of `peers`.
  std::vector<std::uint32_t> other_domains = {};
  /// On radios: bit/s that all robots together may send; their Hellos keep to a part of it.
  double fleet_bits_per_second = 145e3;
  std::size_t queue_messages = 256;     ///< of one topic waiting for their callback; the oldest is dropped
  std::size_t queue_bytes = 64u << 20;  ///< the same in bytes; one message always fits
  bool shared_memory = true;            ///< false leaves out the profile's shared memory transports
};

}  // namespace fleetmap::bus
