#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "fleetmap/bus/dds_bus.hpp"
#include "fleetmap/monitor/live_status.hpp"

namespace fleetmap::apps {

/// Counters of the radios since the start, as the bus and the exchange keep them.
struct RadioCounters {
  std::vector<bus::TopicStats> topics;
  std::uint64_t sent_bytes = 0;   ///< on the wire of the long range, with discovery
  std::size_t message_bytes = 0;  ///< on the wire beside the payload of a message
};

/// Rates of the radios, as differences of their counters.
class RadioRates {
 public:
  static constexpr Duration kWindow = std::chrono::seconds(10);

  /// To be called once a second with the present counters and the traffic since the last call. Fills the
  /// rates of the second (sent, received) and those of the window (kinds, peers).
  monitor::RadioNow add(const RadioCounters& counters, const std::vector<bus::HeardTraffic>& heard,
                        Stamp now);
  /// B/s of submaps received in the window.
  double submap_rate() const;

 private:
  using Kind = std::pair<bus::Link, std::string>;
  using Peer = std::pair<bus::Link, AgentId>;
  struct Sums {
    std::uint64_t sent = 0, received = 0;
  };
  struct Second {
    Stamp at;
    std::uint64_t sent_bytes = 0;
    std::map<Kind, Sums> kinds;            ///< since the start
    std::vector<bus::HeardTraffic> heard;  ///< in this second
  };
  double seconds() const { return to_seconds(window_.back().at - window_.front().at); }
  std::vector<monitor::KindRate> kind_rates() const;
  std::vector<monitor::PeerRate> peer_rates() const;

  std::deque<Second> window_;
};

/// "fleetmap/cloud_fragment/r2" -> "cloud_fragment"
std::string kind_of_topic(const std::string& topic);

}  // namespace fleetmap::apps
