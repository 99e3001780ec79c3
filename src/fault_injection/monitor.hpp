#pragma once

#include <deque>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/fault_injection/exchange_fleet.hpp"
#include "fleetmap/fault_injection/fleet_run.hpp"

namespace fleetmap::fault_injection {

/// The items that one robot holds.
struct Holdings {
  store::SeqSet nodes, alignments, submaps;
};

/// Watches the packets and stores of a fleet, and notes what violates an invariant.
class Monitor {
 public:
  Monitor(Stamp start, const exchange::ExchangeConfig& config, std::set<Invariant> checked)
      : start_(start), config_(&config), checked_(std::move(checked)) {}

  void note(Invariant invariant, const AgentId& robot, Stamp now, const std::string& what);
  /// `hearers`: the robots that hear this packet on the radio, whoever it is for, without its sender.
  void on_sent(const Packet& packet, const std::vector<AgentId>& hearers);
  void on_started(const AgentId& robot, const store::Store& store, bool disk_intact, Stamp now);
  /// The node is in the store of its maker, with its submap.
  void on_made(const graph::Node& node);
  /// An attacker sent an item of this name, which can cost its maker the name, but not the content.
  void on_forged(const messages::Message& message);
  void on_stopped(const AgentId& robot) { sent_.erase(robot); }
  void on_conflict(const AgentId& robot, const exchange::ItemConflict& conflict, Stamp now);
  /// A robot decoded a cloud that came from another.
  void on_decoded(const AgentId& robot, ByteView encoded, const cloud::PointCloud& cloud, Stamp now);
  /// From time to time.
  void check(const std::map<AgentId, ExchangeFleet::Robot>& robots, Stamp now);
  /// From time to time: every chunk of an unfinished download was requested by this robot.
  void check_downloads(const AgentId& robot, const store::Store& store, Stamp now);
  /// When all has come to rest.
  void check_held(const AgentId& robot, const store::Store& store, Stamp now);
  /// Likewise: each node that was made is in the store, perhaps under another name.
  void check_contents(const AgentId& robot, const store::Store& store, Stamp now);

  /// Sets the violations and the packet counts of a run that has ended.
  void fill(Outcome& outcome) const;

 private:
  /// The radio as one robot hears it.
  struct Medium {
    std::deque<std::pair<Stamp, double>> last_second;
    double bytes = 0.0;  ///< in the last second
  };
  void note_radio(const AgentId& at, const Packet& packet);
  void note_announced(const Packet& packet);
  void check_bounds(const AgentId& name, const ExchangeFleet::Robot& robot, Stamp now);

  Stamp start_;
  const exchange::ExchangeConfig* config_;
  std::set<Invariant> checked_;
  std::vector<Violation> violations_;
  std::set<std::pair<Invariant, AgentId>> noted_;
  std::map<AgentId, Holdings> announced_;             ///< by its digests, as long as its disk keeps it
  std::map<AgentId, std::vector<graph::Node>> made_;  ///< as long as the disk of the maker keeps them
  store::SeqSet forged_nodes_, forged_alignments_;    ///< by the names under which an attacker sent some
  std::map<AgentId, std::map<NodeId, std::set<std::uint32_t>>> requested_;  ///< chunks of submaps
  std::map<AgentId, Stamp> sent_;                                           ///< last packet, or start
  std::map<AgentId, Medium> media_;
  double max_bytes_per_second_ = 0.0;
  std::uint64_t packets_ = 0;
  std::uint64_t fingerprint_ = 0xcbf29ce484222325u;
};

}  // namespace fleetmap::fault_injection
