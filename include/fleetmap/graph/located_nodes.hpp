#pragma once

#include <span>
#include <vector>

#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"

namespace fleetmap::graph {

/// The nodes as a placement takes them: each with a G. One that has none gets where it is supposed to be,
/// with a sigma so large that it weighs nothing beside any fix or alignment (1 km, 2 rad of heading):
/// - by its odometry, if another node of its frame has a G;
/// - else as its frame lies to one that is located, where most alignments of the two (in whatever mode)
/// agree;
/// - else, where nothing ties it to any frame with a G, in a frame of its own: level, with the odometry's
///   origin at that of `site`, and what is tied to it accordingly. See not_georeferenced().
///
/// A function of the set alone: sorted by node id, whatever the order given.
std::vector<Node> with_global_poses(std::span<const Node> nodes, std::span<const Alignment> alignments,
                                    const LocalFrame& site, double gps_correlation_time);

/// Frames of the components none of whose nodes has a G: they lie right to each other, but nobody knows where
/// on Earth. `nodes` are as they were made.
std::vector<FrameId> not_georeferenced(std::span<const Node> nodes,
                                       std::span<const std::vector<FrameId>> components);

}  // namespace fleetmap::graph
