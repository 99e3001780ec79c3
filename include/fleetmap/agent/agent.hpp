#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fleetmap/agent/agent_config.hpp"
#include "fleetmap/agent/fleet_link.hpp"
#include "fleetmap/agent/node_factory.hpp"
#include "fleetmap/agent/odometry_frame.hpp"
#include "fleetmap/agent/perception.hpp"
#include "fleetmap/agent/registration_recorder.hpp"
#include "fleetmap/agent/sensor_facts.hpp"
#include "fleetmap/agent/store_failures.hpp"
#include "fleetmap/agent/track_recorder.hpp"
#include "fleetmap/core/quantile_sketch.hpp"
#include "fleetmap/graph/pose_now.hpp"
#include "fleetmap/loop_closure/loop_closing.hpp"
#include "fleetmap/store/sessions.hpp"

namespace fleetmap::agent {

class LivePlacement;
class Navigator;

/// CPU seconds of the work that a robot offloads.
struct WorkSeconds {
  double odometry = 0.0;
  double registration = 0.0;  ///< without the spherization of its clouds
  double spherization = 0.0;
  double placement = 0.0;  ///< solutions of the fleet's graph while driving

  WorkSeconds& operator+=(const WorkSeconds& other) {
    odometry += other.odometry;
    registration += other.registration;
    spherization += other.spherization;
    placement += other.placement;
    return *this;
  }
};

/// One robot: wires all components on one Bus and calls them in order.
/// sensors -> O, G -> node -> ball tree -> exchange -> registration -> alignment -> placement -> merged map.
class Agent {
 public:
  /// Opens (or goes on from) the store in config.directory. `bus` outlives the agent.
  static Result<std::unique_ptr<Agent>> create(const AgentConfig& config, bus::Bus& bus);
  ~Agent();
  Agent(const Agent&) = delete;
  Agent& operator=(const Agent&) = delete;

  /// Calls `on_pose` with the poses of every scan that the odometry could use.
  void observe_poses(std::function<void(const graph::PoseNow&)> on_pose) { on_pose_ = std::move(on_pose); }
  /// The store's content as it was last placed while driving, with placement.method `graph`; null before.
  std::shared_ptr<const graph::PlacedFleet> placed_fleet() const;
  /// Configured mounts to be published in /tf_static, when there are new ones.
  std::vector<sensor::FrameTransform> take_unpublished_mounts() {
    return perception_->take_unpublished_mounts();
  }
  /// Makes a node of the points since the last one, as at the end of a mission, and continues with the next
  /// scan.
  void freeze_rest();
  /// Stops the robot; everything else continues. To be called first when the program ends.
  void halt();
  /// Ends all subscriptions. Offloaded work must also have ended before the agent is destroyed.
  void stop();
  /// Sends an operator's order, given on this robot, to all, as Exchange::on_local_order() does.
  /// `Order`: messages::HoldOrder or RowOrder.
  template <class Order>
  void give_order(const Order& order);
  /// True if no scan, registration or message waits.
  bool idle() const;
  /// True if every node, alignment and submap that it has heard of is held, except those of robots that the
  /// mission counts as lost.
  bool complete() const { return exchange_->complete(lost()); }
  /// True if every other agent that is not lost has reported that it holds our nodes and alignments.
  bool fleet_caught_up() const { return exchange_->fleet_caught_up(lost()); }
  /// True if another robot still makes nodes or alignments.
  bool others_busy() const { return exchange_->others_busy(bus_.now()); }
  /// Times of the last sensor sample and of the last item exchanged, on the bus's clock.
  Stamp last_sensor() const { return perception_->last_sample(); }
  Stamp last_exchange() const { return link_->counters().last_useful; }

  const AgentConfig& config() const { return config_; }
  const store::Store& store() const { return store_; }
  store::Store& store() { return store_; }
  const Perception& perception() const { return *perception_; }
  const exchange::Exchange& exchange() const { return *exchange_; }
  exchange::ExchangeStats exchange_stats() const { return exchange_->stats(); }
  /// Robots from which submaps are being fetched.
  std::vector<AgentId> submap_requesters() const { return exchange_->submap_requesters(); }
  const FleetLinkCounters& link_counters() const { return link_->counters(); }
  /// Writes that the disk refused.
  std::uint64_t store_failures() const { return store_failures_.total(); }
  std::vector<bus::TopicStats> bus_stats() const { return bus_.stats(); }
  const loop_closure::RegistrationCounters& registrations() const { return loop_closing_.registrations(); }
  loop_closure::CandidateStats candidate_stats() const { return loop_closing_.stats(); }
  /// Candidates with each other robot, if there are any.
  std::map<AgentId, loop_closure::PeerCandidates> candidates_by_peer() const {
    return loop_closing_.by_peer();
  }
  /// The driver of the robot; null if this agent does not drive.
  const Navigator* navigator() const { return navigator_.get(); }
  /// CPU seconds of LOAM a scan.
  const QuantileSketch& scan_seconds() const { return scan_seconds_; }
  /// Counts work that has finished.
  WorkSeconds work_seconds() const;

 private:
  Agent(const AgentConfig& config, bus::Bus& bus, store::Store store, store::Sessions sessions,
        std::uint16_t session, TrackRecorder tracks);
  Status start();
  /// Robots of the mission that have been silent for long.
  std::set<AgentId> lost() const;

  void on_estimate(ScanEstimate&& estimate);
  /// Makes a node at the last scan, stores it and sends it to the fleet.
  void freeze_node();
  /// Begins a session, since the odometry continues in another frame. `why` is for the log. Returns false if
  /// the store failed.
  bool begin_session(const char* why);
  bool numbers_run_out() const;
  /// With the first scan: by then the mount is decided.
  void keep_facts();
  void navigate();
  /// Handles an order from a button on the robot.
  void on_local_hold(const Bytes& cdr);
  void on_events();
  void handle(const exchange::CloudNeeded& needed);
  void handle(const exchange::MissionHeard& heard);
  void handle(const exchange::HoldChanged& changed);
  void handle(const exchange::RowsOrdered& ordered);
  void handle(const exchange::ItemConflict& conflict);
  void handle(const exchange::SessionTaken& taken);
  void handle(const exchange::StoreFailed& failed);
  void handle(const exchange::NodeAdded& added);
  // Nothing follows from these but a line in the log (event_log.hpp).
  void handle(const exchange::PeerStatus&) {}
  void handle(const exchange::ItemRefused&) {}
  void handle(const exchange::ItemsAdopted&) {}
  void handle(const exchange::OfferUndelivered&) {}
  void handle(const exchange::OwnItemsElsewhere&) {}
  void handle(const exchange::SenderMisbehaved&) {}
  void handle(const exchange::StrangerHeard&) {}
  void handle(const exchange::AlignmentAdded&) {}
  void handle(const exchange::SubmapAdded&) {}
  void handle(const exchange::MapComplete&) {}
  /// Gives new names to own items whose names are contested.
  void name_contested_anew();

  /// Names the alignment, stores it and sends it to the fleet. Returns false if it was refused.
  bool publish(graph::Alignment alignment);
  void update_status();

  AgentConfig config_;
  bus::Bus& bus_;
  store::Store store_;
  store::Sessions sessions_;
  std::uint16_t session_;
  SensorFacts facts_;
  bool rest_frozen_for_meeting_ = false;
  bool own_item_contested_ = true;  ///< perhaps: also before the start
  TrackRecorder tracks_;
  RegistrationRecorder registrations_;
  NodeFactory nodes_;
  loop_closure::LoopClosing loop_closing_;
  std::optional<exchange::Exchange> exchange_;
  OdometryFrame frame_;
  QuantileSketch scan_seconds_;
  std::unique_ptr<Perception> perception_;
  std::unique_ptr<FleetLink> link_;
  std::unique_ptr<Navigator> navigator_;
  std::unique_ptr<LivePlacement> live_placement_;  ///< with placement.method `graph`
  bus::Handle live_timer_;
  bus::Handle status_timer_;
  bus::Handle navigator_timer_;
  bus::Handle local_hold_;
  Stamp begun_{};          ///< when the program started
  Stamp session_begun_{};  ///< if it was not with the program's start
  StoreFailures store_failures_;
  std::function<void(const graph::PoseNow&)> on_pose_;
};

}  // namespace fleetmap::agent
