#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fleetmap/agent/agent_config.hpp"
#include "fleetmap/agent/failure_log.hpp"
#include "fleetmap/agent/fleet_link.hpp"
#include "fleetmap/agent/global_track.hpp"
#include "fleetmap/agent/level_track.hpp"
#include "fleetmap/agent/perception.hpp"
#include "fleetmap/agent/recent_surroundings.hpp"
#include "fleetmap/agent/sessions.hpp"
#include "fleetmap/agent/submap_builder.hpp"
#include "fleetmap/agent/trajectory_file.hpp"
#include "fleetmap/loop_closure/loop_closing.hpp"
#include "fleetmap/odometry/motion_covariance.hpp"
#include "fleetmap/store/registration_log.hpp"

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

/// One robot: every component on one Bus, and the only place that knows their order.
/// sensors -> O, G -> node -> ball tree -> exchange -> registration -> alignment -> placement -> merged map.
class Agent {
 public:
  /// Opens (or goes on from) the store in config.directory. `bus` outlives the agent.
  static Result<std::unique_ptr<Agent>> create(const AgentConfig& config, bus::Bus& bus);
  ~Agent();
  Agent(const Agent&) = delete;
  Agent& operator=(const Agent&) = delete;

  /// Freezes what was seen since the last node, as when a mission ends. Goes on with the next scan.
  void freeze_rest();
  /// The robot stands still from now on; everything else goes on. The first thing to do when told to end.
  void halt();
  /// Hears no more sensors and messages. Before the agent is destroyed, offloaded work must have ended, too.
  void stop();
  /// Nothing waits: no scan, no registration, no message.
  bool idle() const;
  /// Every node, alignment and submap that it has heard of is held. What only a robot had that the mission
  /// counts as lost is not waited for.
  bool complete() const { return exchange_->complete(lost()); }
  /// Every other agent that is not lost has told that it holds our nodes and alignments.
  bool fleet_caught_up() const { return exchange_->fleet_caught_up(lost()); }
  /// Another robot still makes nodes or alignments.
  bool others_busy() const { return exchange_->others_busy(bus_.now()); }
  /// When a sensor was last heard, and when the last item moved, on the bus's clock.
  Stamp last_sensor() const { return perception_->last_heard(); }
  Stamp last_exchange() const { return link_->counters().last_useful; }

  const AgentConfig& config() const { return config_; }
  const store::Store& store() const { return store_; }
  store::Store& store() { return store_; }
  const Perception& perception() const { return *perception_; }
  exchange::ExchangeStats exchange_stats() const { return exchange_->stats(); }
  /// Whom submaps are fetched from at this moment.
  std::vector<AgentId> asked_for_submaps() const { return exchange_->asked_for_submaps(); }
  const FleetLinkCounters& link_counters() const { return link_->counters(); }
  /// Writes that the disk refused.
  std::uint64_t store_failures() const { return store_failures_.total(); }
  std::vector<bus::TopicStats> bus_stats() const { return bus_.stats(); }
  const loop_closure::RegistrationCounters& registrations() const { return loop_closing_.registrations(); }
  loop_closure::LoopClosureStats loop_closure_stats() const { return loop_closing_.stats(); }
  /// What drives the robot, if this agent does.
  const Navigator* navigator() const { return navigator_.get(); }
  /// CPU seconds of each scan, as LOAM took them.
  const std::vector<double>& scan_seconds() const { return scan_seconds_; }
  /// Counts what has come to its end.
  WorkSeconds work_seconds() const;

 private:
  Agent(const AgentConfig& config, bus::Bus& bus, store::Store store, Sessions sessions,
        std::uint16_t session, TrajectoryFile odometry_file, GlobalTrackFile global_file);
  Status start();
  /// Robots that were not heard of for long on a mission.
  std::set<AgentId> lost() const;

  void on_perceived(Perceived&& perceived);
  void freeze_node(const Perceived& perceived);
  /// What the odometry computes from now on is in another frame. `why` is for people. False: the store
  /// failed.
  bool begin_session(const char* why);
  bool numbers_run_out() const;
  void navigate();
  /// From a button on the robot.
  void on_local_hold(const Bytes& cdr);
  /// GPS may take a while to begin with; nodes without G are made only when it does not come.
  bool worth_waiting_for_gps();
  void on_events();
  void handle(const exchange::CloudNeeded& needed);
  void handle(const exchange::PeerStatus& status);
  void handle(const exchange::MissionHeard& heard);
  void handle(const exchange::HoldChanged& changed);
  void handle(const exchange::ItemConflict& conflict);
  void handle(const exchange::ItemRefused& refused);
  void handle(const exchange::ItemsAdopted& adopted);
  void handle(const exchange::OfferUndelivered& doubted);
  /// Own items whose names are contested get others.
  void name_contested_anew();
  void handle(const exchange::OwnItemsElsewhere& found);
  void handle(const exchange::SessionTaken& taken);
  void handle(const exchange::StrangerHeard& heard);
  void handle(const exchange::StoreFailed& failed);
  void note_store_that_works();
  void handle(const exchange::NodeAdded& added);
  void handle(const exchange::AlignmentAdded& added);
  void handle(const exchange::SubmapAdded&) {}
  void handle(const exchange::MapComplete& complete);

  /// The alignment gets a name, is stored, and goes to the fleet. False: it was refused.
  bool publish(graph::Alignment alignment);
  /// A registration has ended.
  void record(const loop_closure::Registration& registration);
  void log_registration(const loop_closure::Registration& registration);
  /// Keeps both clouds, so that the pair can be registered again by another method.
  void keep_input(const store::LoggedRegistration& input);
  void update_status();

  AgentConfig config_;
  bus::Bus& bus_;
  store::Store store_;
  Sessions sessions_;
  std::uint16_t session_;
  bool told_of_missing_gps_ = false;
  bool rest_frozen_for_meeting_ = false;
  bool own_item_contested_ = true;               ///< perhaps: also before the start
  std::optional<TrajectoryFile> odometry_file_;  ///< none: it could not be begun, and holds no other frame
  GlobalTrackFile global_file_;
  std::optional<store::RegistrationLog> registration_log_;  ///< empty once it could not be written
  double odometry_seconds_ = 0.0;                           ///< CPU
  SubmapBuilder submap_;
  RecentSurroundings recent_surroundings_;
  place::NodeGenerator node_generator_;
  LevelTrack level_;
  odometry::MotionCovariance motion_;  ///< since the last node
  loop_closure::LoopClosing loop_closing_;
  std::optional<exchange::Exchange> exchange_;
  std::optional<Perceived> last_perceived_;  ///< without its points
  std::uint64_t map_restarts_ = 0;           ///< of the odometry, seen so far
  std::uint64_t clock_resets_ = 0;           ///< likewise
  std::vector<double> scan_seconds_;
  std::optional<Stamp> waiting_for_gps_until_;  ///< for the first global pose
  std::unique_ptr<Perception> perception_;
  std::unique_ptr<FleetLink> link_;
  std::unique_ptr<Navigator> navigator_;
  std::unique_ptr<LivePlacement> live_placement_;  ///< with placement.method `graph`
  bus::Handle live_timer_;
  bus::Handle status_timer_;
  bus::Handle navigator_timer_;
  bus::Handle local_hold_;
  Stamp session_begun_{};  ///< if it was not with the program's start
  FailureLog store_failures_;
  std::uint64_t added_before_failure_ = 0;  ///< StoreStats::added
};

}  // namespace fleetmap::agent
