#pragma once

#include <cstddef>
#include <cstdint>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/exchange/cloud_transfer_config.hpp"
#include "fleetmap/loop_closure/descriptor_match_config.hpp"
#include "fleetmap/place/proximity_search.hpp"

namespace fleetmap::loop_closure {

/// Selection and timing of registrations between two robots.
struct CandidateConfig {
  place::ProximityConfig proximity;  ///< r^i of Eq. 1
  /// m, horizontal, of a G that proposes candidates; beyond it, and without G, descriptors do.
  double max_sigma_m = 15.0;
  DescriptorMatchConfig descriptors;
  double spacing_m = 10.0;          ///< m between candidates of the same two agents
  double spacing_aligned_m = 20.0;  ///< m, the same once the two have a good alignment (E_ij <= 0.4)
  double spacing_failed_m = 5.0;    ///< m from a candidate that was rejected or whose cloud got lost
  /// The cloud around a node is complete only some nodes later, and a nearer pair may be found until then. A
  /// cloud is requested when both robots have made so many nodes more ...
  std::uint32_t min_nodes_after = 3;
  Duration max_wait = std::chrono::seconds(20);  ///< ... or this long after the pair was found
  Duration retry_after =
      std::chrono::seconds(60);  ///< s until a failed pair is tried again, with fuller clouds
  int max_attempts = 2;          ///< of one pair of nodes
  /// order in which clouds are requested, and in which they are sent
  exchange::CloudOrder order = exchange::CloudOrder::kInformation;
  /// nats; a candidate with less when it could be requested is dropped, unless the radio has room.
  double min_information = 0.4;
  std::size_t max_active = 2;                        ///< clouds requested and not yet registered
  std::size_t max_waiting = 256;                     ///< candidates not yet requested; the oldest is dropped
  Duration peer_timeout = std::chrono::seconds(60);  ///< s; an agent silent for longer gets no requests
  int match_repeats = 3;  ///< a match is sent so often unless the peer shows that it has the pair
  Duration match_period = std::chrono::seconds(3);  ///< s
  /// A good alignment of the same two nodes by the peer ends our own attempt.
  bool stop_when_peer_aligned = true;
  Status validate() const;
};

}  // namespace fleetmap::loop_closure
