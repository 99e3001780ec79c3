#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "fleetmap/agent/agent.hpp"
#include "fleetmap/bus/bus.hpp"
#include "fleetmap/ros_output/map_points.hpp"
#include "health/sensor_rates.hpp"
#include "link_log.hpp"

namespace fleetmap::apps {

/// Publishes what ROS 2's tools show of a robot on its onboard link (ros_codec::topics::outputs()). Computes
/// nothing that nobody hears. Used on the bus's callback thread.
class RosPublisher {
 public:
  struct Edges {
    std::function<std::size_t(const bus::Topic&)> readers;  ///< of the topic
    /// Runs `work` anywhere, then `done` on the callback thread. False: neither.
    std::function<bool(std::function<void()> work, std::function<void()> done)> offload;
    /// Empty where that is not known.
    std::function<std::map<LinkLog::Source, LinkLog::Heard>()> last_heard;
  };
  /// Both outlive it, and it outlives the work under way.
  RosPublisher(agent::Agent& agent, bus::Bus& bus, const ros_output::RosOutputConfig& config, Edges edges);
  ~RosPublisher();
  RosPublisher(const RosPublisher&) = delete;
  RosPublisher& operator=(const RosPublisher&) = delete;

 private:
  struct MapJob;
  bool wanted(const bus::Topic& topic) const { return edges_.readers(topic) > 0; }
  void update_view();
  std::shared_ptr<ros_output::MapBuilder> empty_map() const;
  void on_pose(const graph::PoseNow& pose);
  void tick();
  void publish_mounts();
  void publish_diagnostics();
  /// Publishes `message()` once for each view if the topic has subscribers.
  void publish_view(const bus::Topic& topic, const std::function<Bytes()>& message);
  void update_map();
  void forget_map();
  /// Adds the submaps that the map lacks, a few at a time, and those to be published.
  void fill(MapJob& job);
  /// On any thread.
  static void build(MapJob& job);
  void publish(const MapJob& job);

  agent::Agent& agent_;
  bus::Bus& bus_;
  ros_output::RosOutputConfig config_;
  Edges edges_;
  SensorRates rates_;
  std::shared_ptr<const graph::PlacedFleet> fleet_;
  /// Drawn of fleet_; empty before the first, which clears the drawings of an earlier start.
  std::shared_ptr<const monitor::FleetView> view_;
  std::map<std::string, std::shared_ptr<const monitor::FleetView>> published_;  ///< by topic
  std::shared_ptr<ros_output::MapBuilder> map_;  ///< touched by the work under way alone
  bool map_under_way_ = false;
  bool map_grew_ = false;  ///< since the whole was published
  Stamp next_map_;
  std::map<NodeId, Pose> T_map_submap_;  ///< published
  std::set<NodeId> in_map_;              ///< or damaged
  std::size_t submap_readers_ = 0;
  bus::Handle timer_;
};

}  // namespace fleetmap::apps
