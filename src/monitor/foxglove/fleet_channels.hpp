#pragma once

#include <map>
#include <memory>
#include <span>
#include <vector>

#include "channel.hpp"
#include "fleetmap/core/bytes.hpp"
#include "fleetmap/monitor/fleet_view.hpp"
#include "fleetmap/monitor/live_status.hpp"
#include "robot_messages.hpp"

namespace fleetmap::monitor::foxglove {

/// The channels of a fleet and the newest message of each. Channels are only ever added: those of the fleet
/// at the start, those of a robot when it has a place on Earth or a status. A message is made when it is
/// asked for, once for all clients.
class FleetChannels {
 public:
  FleetChannels();
  void show(std::shared_ptr<const FleetView> view);
  void show(std::shared_ptr<const LiveStatus> status);
  /// The map's message, which others build (ThinnedMap).
  void show_map(Bytes message);

  /// The k-th has the id k + 1.
  std::span<const Channel> channels() const { return channels_; }
  /// Null while there is none. `id` must be one of channels().
  std::shared_ptr<const Bytes> message(std::uint32_t id);

  static constexpr std::uint32_t kMapChannel = 4;

 private:
  struct Made {
    std::uint64_t revision = 0;
    std::shared_ptr<const Bytes> message;
  };
  void add(const std::string& topic, ChannelKind kind, const AgentId& robot = {});
  void add_once(ChannelKind kind, const AgentId& robot);
  std::shared_ptr<const Bytes> make(const Channel& channel) const;

  std::vector<Channel> channels_;
  std::vector<Made> made_;  ///< parallel to channels_
  std::shared_ptr<const FleetView> view_;
  std::shared_ptr<const LiveStatus> status_;
  std::shared_ptr<const Bytes> map_;
  std::map<AgentId, LastNode> last_nodes_;  ///< of view_
};

}  // namespace fleetmap::monitor::foxglove
