#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "fleetmap/core/time.hpp"
#include "fleetmap/monitor/fleet_view.hpp"

/// The drawing of a fleet in ENU, whatever shows it.
namespace fleetmap::monitor {

/// Stamp of the newest node; the epoch without any.
Stamp newest_stamp(const FleetView& view);

/// The newest placed node of a robot.
struct LastNode {
  NodeId id;
  Stamp stamp;
  Pose T_enu_node = Pose::Identity();
  bool georeferenced = false;  ///< else its place on Earth is not known
  std::optional<Matrix6d> covariance;
};
std::map<AgentId, LastNode> last_nodes(const FleetView& view);

/// 0xrrggbb of each robot, by its place in the fleet: those of the page.
std::map<AgentId, std::uint32_t> robot_colors(const FleetView& view);

/// Placed nodes by odometry frame, each in the order in which they were made; m.
std::map<graph::FrameId, std::vector<Eigen::Vector3d>> tracks_of(const FleetView& view);

/// The alignments of one status between placed nodes.
struct AlignmentLines {
  graph::AlignmentStatus status = graph::AlignmentStatus::undecided;
  std::uint32_t rgb = 0;                ///< 0xrrggbb
  std::vector<Eigen::Vector3d> points;  ///< m, two for each alignment
};
/// All statuses, also those without any.
std::vector<AlignmentLines> alignment_lines(const FleetView& view);

}  // namespace fleetmap::monitor
