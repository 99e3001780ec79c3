#pragma once

#include <span>

#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"
#include "fleetmap/graph/paper_placement_config.hpp"
#include "fleetmap/graph/placement.hpp"

namespace fleetmap::graph {

/// The paper's scheme (method `paper`): one rigid transform per pair of agents, that of the alignment with
/// the least E_ij, of those with one mode; each connected group of agents is then laid on its nodes' global
/// poses G by least squares.
Placement place_by_min_rmse(std::span<const Node> nodes, std::span<const Alignment> alignments,
                            const LocalFrame& site, const PaperPlacementConfig& config = {});

}  // namespace fleetmap::graph
