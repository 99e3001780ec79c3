#pragma once

#include <optional>
#include <string>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/graph/placement.hpp"

namespace fleetmap::monitor {

/// One registration that a robot ran: a line of its registrations.csv.
struct Attempt {
  AgentId by;
  NodeId target, source;
  std::string verdict;  ///< accepted, ambiguous, rejected or failed
  std::optional<double> rmse_m, inlier_fraction, overlap;
  std::string reason;                        ///< empty when accepted
  std::optional<Pose> T_target_source = {};  ///< of the best mode, if it is known
  std::optional<Stamp> done = {};            ///< by the clock of `by`, if it is known
};

/// Describes the attempt and its outcome in one sentence. `status` is the graph's decision about its
/// alignment, if it has one.
std::string sentence(const Attempt& attempt, std::optional<graph::AlignmentStatus> status);
/// The graph's decision about an alignment, as the end of a sentence: "the graph uses it".
std::string fate(graph::AlignmentStatus status);

}  // namespace fleetmap::monitor
