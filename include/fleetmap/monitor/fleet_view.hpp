#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"
#include "fleetmap/graph/placement.hpp"
#include "fleetmap/monitor/attempt.hpp"
#include "fleetmap/monitor/pair_candidates.hpp"
#include "fleetmap/monitor/radio_history.hpp"

namespace fleetmap::monitor {

/// Share of the items that `maker` made which one robot holds.
struct Holding {
  AgentId holder, maker;
  std::size_t nodes = 0, submaps = 0, alignments = 0;
};

/// All that the page shows of a fleet, as one robot holds it. A value: whoever has it may hand it to any
/// thread.
struct FleetView {
  std::string title;           ///< where it comes from: a folder, a store, a robot
  AgentId self;                ///< the robot whose store this is
  std::vector<AgentId> fleet;  ///< robots that should be there by the configuration, if it is known
  GeoPoint origin;             ///< of ENU
  std::vector<graph::Node> nodes;
  std::vector<bool> has_submap;  ///< parallel to `nodes`
  std::vector<graph::Alignment> alignments;
  graph::Placement placement;
  double search_radius_m =
      30.0;  ///< m, r_max of the proximity search (Eq. 1): only nodes so near are registered
  std::vector<Attempt> attempts;           ///< of the robots in `logs`
  std::vector<AgentId> logs;               ///< robots whose registrations.csv was read
  std::vector<PairCandidates> candidates;  ///< of finished robots, as their reports have them
  std::vector<Holding> holdings;           ///< of all robots whose stores are known
  RadioHistory radio;                      ///< of finished robots, as their files have it
  std::vector<std::string> notes;          ///< files that could not be read
};

/// The configured robots and all that made a node or an alignment, ran a registration or hold something, by
/// name.
std::vector<AgentId> robots_of(const FleetView& view);

/// Status of each alignment in the placement, by (computed_by, seq). In mode `paper` only used ones have one.
using Outcomes = std::map<std::pair<AgentId, std::uint32_t>, graph::AlignmentStatus>;
Outcomes outcomes_of(const FleetView& view);

/// Parallel to FleetView::attempts: the alignment that came of each attempt, as an index into
/// FleetView::alignments.
std::vector<std::optional<std::size_t>> alignments_of_attempts(const FleetView& view);

}  // namespace fleetmap::monitor
