#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "candidate_set.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/graph/information_gain.hpp"
#include "node_index.hpp"

namespace fleetmap::loop_closure {

/// Selects the candidates whose clouds are requested next: both clouds are complete, the other robot is
/// heard, and the alignment adds the most information to the fleet's graph (InformationGain).
class CandidateSelection {
 public:
  struct Selected {
    NodePair pair;
    double information = 0.0;  ///< nats
  };

  /// The references outlive this.
  CandidateSelection(const CandidateConfig& config, const NodeIndex& nodes, CandidateSet& candidates)
      : config_(config), nodes_(nodes), candidates_(candidates) {}

  graph::InformationGain& information() { return information_; }
  /// Candidates whose clouds may be requested; drops those that others have made redundant meanwhile, and
  /// gives up those that cannot be tried again.
  std::vector<NodePair> ready(const std::function<bool(const AgentId&)>& is_heard, Stamp now);
  /// Removes the next candidate from `ready` and returns it. Without room on the radio, candidates below
  /// min_information are dropped.
  std::optional<Selected> next(std::vector<NodePair>& ready, bool radio_has_room);
  /// Candidates dropped because of min_information.
  std::uint64_t uninformative_count() const { return uninformative_; }

 private:
  bool clouds_complete(const NodePair& pair, const ScheduledCandidate& candidate, Stamp now) const;

  const CandidateConfig& config_;
  const NodeIndex& nodes_;
  CandidateSet& candidates_;
  graph::InformationGain information_;
  std::uint64_t uninformative_ = 0;
};

}  // namespace fleetmap::loop_closure
