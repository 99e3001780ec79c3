#pragma once

#include <span>
#include <vector>

#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"

namespace fleetmap::graph {

/// The nodes, sorted by id, each with a G as the placement needs it. A node without one gets an assumed pose
/// with a sigma so large that it has no weight beside any fix or alignment (1 km, 2 rad of heading):
/// - by its odometry, if another node of its frame has a G;
/// - else by a frame that is located already, where most alignments of the two (in any mode) agree;
/// - else, if no alignments connect it to a frame with a G, in a frame of its own: level, with the origin of
/// the
///   odometry at that of `site`. See not_georeferenced().
///
/// The result depends on the set alone, not on its order.
std::vector<Node> with_global_poses(std::span<const Node> nodes, std::span<const Alignment> alignments,
                                    const LocalFrame& site, double gps_correlation_time);

/// Frames of the components without any G: their relative poses are determined, their pose on Earth is not.
/// `nodes` are the original ones, without assumed poses.
std::vector<FrameId> not_georeferenced(std::span<const Node> nodes,
                                       std::span<const std::vector<FrameId>> components);

}  // namespace fleetmap::graph
