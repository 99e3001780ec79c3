#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "fleetmap/agent/drive_guard.hpp"
#include "fleetmap/agent/navigator_config.hpp"
#include "fleetmap/agent/obstacles.hpp"
#include "fleetmap/agent/perception.hpp"
#include "fleetmap/bus/bus.hpp"
#include "fleetmap/core/ids.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/messages/messages.hpp"
#include "fleetmap/planning/driving/path_follower.hpp"
#include "fleetmap/planning/mission/fleet_plan.hpp"
#include "fleetmap/planning/mission/mission_executive.hpp"
#include "fleetmap/planning/mission/row_coverage.hpp"

namespace fleetmap::agent {

/// Drives one robot through its part of the mission: poses and scans in, cmd_vel out. Reports its progress to
/// the others and takes over rows that they cannot drive. Navigates by the EKF's pose, or by that of
/// fleet_codec::topics::guide_pose() while one arrives (so that a robot without GPS can be guided), and
/// avoids obstacles by the scan. Every command passes a DriveGuard; while the guard has a reason, zero is
/// published every DriveGuard::kPeriod.
class Navigator {
 public:
  using SendReport = std::function<void(messages::MissionReport)>;
  /// `site`: the ENU frame of the plan. `send_report` sends a report to the others. Fails if `self` is not in
  /// the plan.
  static Result<std::unique_ptr<Navigator>> create(const NavigatorConfig& config, const AgentId& self,
                                                   const GeoPoint& site, bus::Bus& bus,
                                                   SendReport send_report);

  ~Navigator();

  /// To be called when a scan arrives.
  void on_scan() { guard_.on_scan(bus_.now()); }
  /// To be called with the result of every scan.
  void on_estimate(const ScanEstimate& estimate);
  void on_report(const messages::MissionReport& report);
  /// To be called some times a second. `maps_exchanged`: this robot holds everything, and the others hold all
  /// that it has heard of. `exchanged_with`: robots in reach with which nothing is left to exchange.
  void tick(bool maps_exchanged, std::vector<AgentId> exchanged_with = {});
  /// Adds a node of any robot as evidence that its surroundings were driven.
  void on_node(const graph::Node& node);
  /// Follows the order of an operator that is in force.
  void obey(const messages::HoldOrder& order);
  /// Follows the operators' orders for rows; those given before and missing here no longer hold.
  void obey(const std::vector<messages::RowOrder>& orders);
  /// Stands still from now on.
  void stop();
  /// Why the robot stands still; nothing if it may be driven.
  std::optional<StopReason> stop_reason() const { return stop_reason_; }

  /// Nothing is left to do for this robot.
  bool done() const { return action_.kind == planning::MissionAction::Kind::kDone; }
  /// True if every row of the mission has been driven or given up, as far as reports have arrived.
  bool all_rows_driven() const;
  planning::MissionExecutive::Status status() const { return executive_.status(); }
  /// Own progress and the last report of each other robot.
  const planning::MissionExecutive& executive() const { return executive_; }
  std::optional<double> battery() const { return battery_; }

 private:
  Navigator(const NavigatorConfig& config, const AgentId& self, planning::MissionExecutive executive,
            const GeoPoint& site, bus::Bus& bus, SendReport send_report);
  /// Publishes the command, or zero if the guard has a reason.
  void drive(const planning::Command& command);
  void watch();
  void note(const std::optional<StopReason>& reason);
  /// Takes the pose of the scan; whether the mission can be driven by it.
  bool locate(const ScanEstimate& estimate);
  bool stuck(Stamp now) const;
  std::optional<planning::Pose2> pose_of(const GlobalPose& G) const;
  bool guided() const;

  NavigatorConfig config_;
  LocalFrame site_;
  AgentId self_;
  bus::Bus& bus_;
  SendReport send_report_;
  planning::MissionExecutive executive_;
  planning::RowCoverage coverage_;
  planning::PathFollower follower_;
  planning::MissionAction action_;
  std::optional<planning::Pose2> pose_;
  std::optional<planning::Pose2> guide_;  ///< the last pose of the guide
  Stamp guided_at_{};
  DriveGuard guard_;
  std::optional<StopReason> stop_reason_;  ///< as of the last check
  Stamp stopped_since_{};
  bool drove_ = false;             ///< the guard let a command pass
  bool called_home_ = false;       ///< by an operator
  std::optional<double> battery_;  ///< share left
  std::optional<Stamp> next_report_;
  std::vector<bus::Handle> handles_;
  bus::Handle watch_;
};

}  // namespace fleetmap::agent
