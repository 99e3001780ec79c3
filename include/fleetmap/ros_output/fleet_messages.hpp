#pragma once

#include "fleetmap/graph/placed_fleet.hpp"
#include "fleetmap/monitor/fleet_view.hpp"
#include "fleetmap/ros_codec/markers.hpp"
#include "fleetmap/ros_codec/poses.hpp"

namespace fleetmap::ros_output {

/// The fleet as `self` has placed it, for what draws it.
monitor::FleetView view_of(const graph::PlacedFleet& fleet, const AgentId& self);

/// The placed nodes of the view's own robot in the order of time, on the map.
ros_codec::PathMsg path_message(const monitor::FleetView& view);

/// Groups of markers: `tracks` and `nodes` of each robot in its colour, `alignments/STATUS`, and `robots`,
/// the other robots at their last nodes, with their names.
ros_codec::MarkersMsg markers_message(const monitor::FleetView& view);

}  // namespace fleetmap::ros_output
