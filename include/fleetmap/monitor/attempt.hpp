#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/graph/placement.hpp"

namespace fleetmap::monitor {

/// "r1/17" or "r1#4711/17", as fleetmap::to_string(NodeId) writes it.
Result<NodeId> parse_node(std::string_view text);

/// One registration that a robot ran: a line of its registrations.csv.
struct Attempt {
  AgentId by;
  NodeId target, source;
  std::string verdict;  ///< accepted, ambiguous, rejected or failed
  std::optional<double> rmse_m, inlier_fraction, overlap;
  std::string reason;  ///< empty when accepted
};

/// Lines of a registrations.csv that `by` wrote. A line that cannot be read is counted in `damaged`.
struct Attempts {
  std::vector<Attempt> attempts;
  std::size_t damaged = 0;
};
Attempts parse_attempts(std::string_view csv, const AgentId& by);

/// Describes the attempt and its outcome in one sentence. `status` is the graph's decision about its
/// alignment, if it has one.
std::string sentence(const Attempt& attempt, std::optional<graph::AlignmentStatus> status);
/// The graph's decision about an alignment, as the end of a sentence: "the graph uses it".
std::string fate(graph::AlignmentStatus status);

}  // namespace fleetmap::monitor
