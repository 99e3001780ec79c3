#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"
#include "fleetmap/loop_closure/map_session_config.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::loop_closure {

/// A map session: the odometry frames of one store, of robots that mapped together or of one robot on one
/// day.
using MapSession = std::set<graph::FrameId>;
MapSession map_session_of(const store::Store& store);

/// The registrations between two map sessions.
struct MapSessionAlignments {
  /// Computed by the robot of their target, without their sequence numbers.
  std::vector<graph::Alignment> found;
  std::size_t candidates = 0;
  std::size_t accepted = 0;
  std::size_t ambiguous = 0;
  std::map<std::string, std::size_t> rejected;  ///< reason, how often
  /// m, between the two nearest nodes of the two by G; none if one of them has no G.
  std::optional<double> nearest_m;
};

/// Registers the places at which the paths of two map sessions meet. `store` holds the nodes and submaps of
/// both. Candidates are, as on a robot, nodes within r^i of Eq. 1 by G, and descriptor matches where not both
/// nodes have a good G; the nearest come first, and no two of them lie nearer than the spacing at both ends.
/// A frame that both sessions have is not paired. Deterministic; may take a second for each candidate.
MapSessionAlignments align_map_sessions(store::Store& store, const MapSession& earlier,
                                        const MapSession& later, const MapSessionConfig& config);

}  // namespace fleetmap::loop_closure
