#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "fleetmap/agent/agent_config.hpp"
#include "fleetmap/bus/bus.hpp"
#include "fleetmap/graph/contradictions.hpp"
#include "fleetmap/graph/placed_fleet.hpp"
#include "fleetmap/output/trajectory_file.hpp"

namespace fleetmap::agent {

/// The robot's pose on Earth from everything in its store. Solves the fleet's graph in the background when
/// items have arrived, and extrapolates from the newest node by the odometry, which itself never jumps.
class LivePlacement {
 public:
  /// Receives the alignments that the graph uses, after every solution.
  using OnUsed = std::function<void(std::span<const graph::Alignment>)>;
  /// All arguments must outlive it and the work under way.
  LivePlacement(const AgentConfig& config, bus::Bus& bus, const store::Store& store, OnUsed on_used);

  /// Begins a solution unless one is under way, nothing is new, or the share of the CPU is spent
  /// (LivePlacementConfig). publish() then uses the frame of `session`.
  void refresh(std::uint16_t session);
  /// True if no solution is under way and the last one includes all items.
  bool idle() const { return !under_way_ && !due(); }
  /// CPU seconds that all solutions took.
  double cpu_seconds() const { return cpu_seconds_; }
  /// Publishes the corrected pose for a pose of the odometry, once its frame is placed on Earth.
  void publish(const graph::FrameId& frame, const output::StampedPose& odometry);
  /// A frame of this robot by the last solution; empty if it is not part of it.
  std::optional<graph::PlacedFrame> placed(const graph::FrameId& frame) const;
  /// The last solution; null before the first.
  std::shared_ptr<const graph::PlacedFleet> fleet() const { return fleet_; }

 private:
  struct Job;
  /// Logs each agent that contradicts the fleet once.
  void name(const std::map<AgentId, graph::Contradiction>& contradicting);
  static void solve(Job& job);
  bool due() const;
  /// The newest own node of a session.
  std::optional<NodeId> newest_of(std::uint16_t session) const;

  const AgentConfig& config_;
  bus::Bus& bus_;
  const store::Store& store_;
  OnUsed on_used_;
  std::uint64_t items_ = 0;  ///< the store's revision at the last solution
  bool under_way_ = false;
  Stamp paused_until_;
  std::optional<std::uint16_t> solved_session_;  ///< of the newest node in the last solution
  double cpu_seconds_ = 0.0;
  std::optional<graph::PlacedFrame> solution_;
  std::shared_ptr<const graph::PlacedFleet> fleet_;
  std::set<AgentId> named_;  ///< that contradict the fleet
};

}  // namespace fleetmap::agent
