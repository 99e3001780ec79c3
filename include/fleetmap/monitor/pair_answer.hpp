#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fleetmap/monitor/fleet_view.hpp"

namespace fleetmap::monitor {

/// Tells whether two robots' maps are tied together, and why not.
enum class PairState {
  joined,             ///< by alignments of the two
  joined_by_others,   ///< by alignments with other robots
  alignments_unused,  ///< alignments exist, and the graph uses none
  rejected,           ///< every registration was rejected
  no_overlap,         ///< every registration was rejected, most for lack of overlap
  not_tried,          ///< were near each other, and neither registered the other's nodes
  not_known,          ///< were near each other; the log that would list their registrations is not here
  never_near,         ///< never came near enough
  not_tied,           ///< at least one has no place on Earth, so nobody can tell whether they met
  nothing_known,      ///< at least one has no node
};
const char* to_string(PairState state);
constexpr bool is_joined(PairState state) {
  return state == PairState::joined || state == PairState::joined_by_others;
}

struct PairAnswer {
  AgentId a, b;  ///< a < b
  PairState state = PairState::nothing_known;
  std::string text;  ///< answers "Why are a and b not joined?", or what joins them
  std::size_t attempts = 0, accepted = 0, used = 0;
  std::vector<AgentId> missing_logs;  ///< of the two, those whose registrations are not in FleetView::logs
  std::optional<double> nearest_m;    ///< horizontal, between their nodes as placed on Earth
  std::optional<std::pair<NodeId, NodeId>> nearest;
};

/// One answer for each pair of robots, by name.
std::vector<PairAnswer> explain_pairs(const FleetView& view);

}  // namespace fleetmap::monitor
