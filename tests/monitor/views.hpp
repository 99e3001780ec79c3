#pragma once

#include <string>
#include <vector>

#include "fleetmap/monitor/fleet_view.hpp"

namespace fleetmap::testing {

/// A fleet that is made up item by item.
class ViewMaker {
 public:
  ViewMaker();
  /// `count` nodes of a robot, 4 m apart from (east, 0), in an odometry frame of its own component.
  ViewMaker& robot(const std::string& id, double east, int count = 3, bool gps = true);
  ViewMaker& alignment(const NodeId& i, const NodeId& j, graph::AlignmentStatus status);
  ViewMaker& attempt(const NodeId& target, const NodeId& source, const std::string& verdict,
                     const std::string& reason = "");
  /// The registrations of these robots are known, also if there are none.
  ViewMaker& logs(const std::vector<std::string>& ids);
  monitor::FleetView view;

 private:
  void join(const AgentId& a, const AgentId& b);
};

NodeId node_id(const std::string& robot, std::uint32_t seq);

}  // namespace fleetmap::testing
