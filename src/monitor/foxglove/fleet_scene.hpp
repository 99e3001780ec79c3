#pragma once

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/monitor/fleet_view.hpp"

namespace fleetmap::monitor::foxglove {

/// One entity a robot, named by it: its placed nodes as spheres, joined by a line within each session.
/// foxglove::SceneUpdate as CDR.
Bytes trajectories_message(const FleetView& view);

/// One entity per status of an alignment, named by it, also without any: lines between the nodes that the
/// alignments of this status connect. foxglove::SceneUpdate as CDR.
Bytes alignments_message(const FleetView& view);

}  // namespace fleetmap::monitor::foxglove
