#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "descriptor_candidates.hpp"
#include "fleetmap/graph/node.hpp"
#include "fleetmap/loop_closure/candidate_config.hpp"
#include "fleetmap/loop_closure/loop_candidate.hpp"

namespace fleetmap::loop_closure {

/// Candidates between this session and earlier ones of the same robot, whose odometry frames lie anywhere to
/// each other: by position where both nodes have a G with sigma up to CandidateConfig::max_sigma_m, else by
/// descriptor, until the session is joined.
class SessionCandidates {
 public:
  explicit SessionCandidates(const CandidateConfig& config) : config_(config) {}

  /// A session begins after those of the nodes in `earlier`; these must stay where they are.
  void begin(const std::vector<const graph::Node*>& earlier);
  /// A node of an earlier session, which others returned after our store was lost. It must stay where it is.
  void add_earlier(const graph::Node& node);
  /// Nodes of this session, in their order. At most one candidate a node, whose target is the earlier node.
  std::optional<LoopCandidate> propose(const graph::Node& node);
  /// The registration of a node of this session with `earlier` was accepted.
  void on_accepted(const graph::Node& earlier, const graph::Node& later);

 private:
  struct Session {
    std::vector<const graph::Node*> nodes;
    std::optional<DescriptorCandidates> descriptors;       ///< made once it is needed
    int joined_by_position = 0, joined_by_descriptor = 0;  ///< accepted registrations
  };
  bool located(const graph::Node& node) const;
  std::optional<LoopCandidate> nearest(const graph::Node& node) const;
  std::optional<LoopCandidate> best_match(const graph::Node& node);

  CandidateConfig config_;
  std::map<std::uint16_t, Session> earlier_;
};

}  // namespace fleetmap::loop_closure
