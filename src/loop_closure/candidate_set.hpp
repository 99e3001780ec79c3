#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "candidate_grid.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/loop_closure/candidate_config.hpp"
#include "fleetmap/loop_closure/loop_candidate.hpp"
#include "fleetmap/loop_closure/peer_candidates.hpp"
#include "node_index.hpp"

namespace fleetmap::loop_closure {

/// A candidate with another robot, and what has become of it.
struct ScheduledCandidate {
  enum class Phase : std::uint8_t { kWaiting, kRequested, kRegistering, kDone, kFailed };
  LoopCandidate candidate;
  Phase phase = Phase::kWaiting;
  Stamp found;
  Stamp retry_at;  ///< of one that failed
  int attempts = 0;
  bool registered = false;    ///< at least once
  bool by_transform = false;  ///< an inter-frame transform found it, or is its prior
  int matches_sent = 0;
  Stamp next_match;
  bool known_to_peer = false;

  /// Its cloud is requested or being registered.
  bool under_way() const { return phase == Phase::kRequested || phase == Phase::kRegistering; }
};

/// The candidates with other robots, thinned by distance: a candidate is redundant if another one of the
/// same two robots lies nearer than the spacing at both ends. A better candidate replaces one whose cloud
/// was not requested yet.
class CandidateSet {
 public:
  using Phase = ScheduledCandidate::Phase;
  using Candidates = std::map<NodePair, ScheduledCandidate>;

  /// `config` and `nodes` outlive this.
  CandidateSet(const CandidateConfig& config, const NodeIndex& nodes)
      : config_(config), nodes_(nodes), grid_(largest_spacing(config), nodes) {}

  /// Those that are neither done nor abandoned. A long drive has many of these, and they only keep others
  /// away.
  const Candidates& open() const { return candidates_; }
  bool contains(const NodePair& pair) const {
    return candidates_.contains(pair) || done_.contains(pair) || abandoned_.contains(pair);
  }
  /// The node was added to the index.
  void on_node(const NodeId& node) { grid_.on_node(node); }
  /// The node was removed from the index: its candidates no longer keep others away.
  void on_removed_node() { reopen(); }
  /// Null: there is none. One that is done or abandoned is not in open().
  ScheduledCandidate* find(const NodePair& pair);
  ScheduledCandidate& at(const NodePair& pair) { return candidates_.at(pair); }
  /// Makes it if there is none.
  ScheduledCandidate& find_or_make(const NodePair& pair);
  /// Marks the candidate as aligned.
  void conclude(const NodePair& pair);
  /// True for a failed candidate that has used all its attempts, or that is redundant beside a done or an
  /// abandoned one. It becomes retryable() only when such a candidate is erased or a node is removed.
  bool is_exhausted(const NodePair& pair, const ScheduledCandidate& candidate) const;
  /// Takes an exhausted candidate out of open().
  void abandon(const NodePair& pair) { abandoned_.insert(candidates_.extract(pair)); }
  /// The peer has all candidates of our node `ours` with it.
  void set_known_to_peer(const NodeId& ours, const AgentId& peer);
  /// Those in open().
  template <class Visitor>
  void for_each(Visitor visit) {
    for (auto& [pair, candidate] : candidates_) visit(pair, candidate);
  }

  /// Adds a candidate that is neither known nor redundant. It replaces a rival that lies farther apart, or
  /// has a lower score if both are descriptor matches.
  void offer(const LoopCandidate& candidate, Stamp now);
  /// Adds it in any case, unless a node is unknown. The oldest one waiting is dropped if too many wait.
  void add(const LoopCandidate& candidate, Stamp found, bool known_to_peer);
  void erase(const NodePair& pair);
  /// Visits abandoned ones, too.
  template <class Predicate>
  void erase_if(Predicate predicate) {
    std::vector<NodePair> erased;
    for (const Candidates* some : {&candidates_, &abandoned_}) {
      for (const auto& [pair, candidate] : *some) {
        if (predicate(pair, candidate)) erased.push_back(pair);
      }
    }
    for (const NodePair& pair : erased) erase(pair);
  }
  /// Erases one that another has made redundant, and counts it.
  void drop_redundant(const NodePair& pair);

  /// Erases one that would add too little information.
  void drop_uninformative(const NodePair& pair);
  /// By the other robot, without PeerCandidates::heard.
  std::map<AgentId, PeerCandidates> by_peer() const;

  /// The two robots have a good alignment: their candidates are spaced wider from now on.
  void on_aligned(const AgentId& peer) { aligned_.insert(peer); }
  bool is_aligned(const AgentId& peer) const { return aligned_.contains(peer); }

  bool redundant(const NodePair& pair) const { return !too_near(pair, 1).empty(); }
  /// The only candidate that makes the pair redundant, if it may be replaced; at most one.
  std::vector<NodePair> rivals(const NodePair& pair) const;
  /// Candidates that may wait besides those that do.
  std::size_t room() const;
  /// A failed candidate that may be tried again.
  bool retryable(const NodePair& pair, const ScheduledCandidate& candidate) const;

  std::uint64_t redundant_count() const { return redundant_; }
  std::uint64_t overflowed_count() const { return crowded_out_; }
  void count_redundant(std::uint64_t candidates = 1) { redundant_ += candidates; }

 private:
  static double largest_spacing(const CandidateConfig& config) {
    return std::max({1.0, config.spacing_m, config.spacing_aligned_m, config.spacing_failed_m});
  }
  const ScheduledCandidate& held(const NodePair& pair) const;
  /// Candidates with the same agent that are nearer to `pair` than the spacing, `max` of them; with
  /// `closed_only` of those that are done or abandoned.
  std::vector<NodePair> too_near(const NodePair& pair, std::size_t max, bool closed_only = false) const;
  /// Puts abandoned ones that have attempts left back into open().
  void reopen();
  double spacing(const ScheduledCandidate& other, const AgentId& peer) const;
  /// Drops a rival that is worse than `candidate`. Returns since when a candidate of this place has waited.
  Stamp replace_rival(const LoopCandidate& candidate, Stamp now);
  std::size_t waiting() const;
  /// Drops the oldest waiting candidate if too many wait.
  void crowd_out();

  const CandidateConfig& config_;
  const NodeIndex& nodes_;
  Candidates candidates_;
  Candidates done_;
  Candidates abandoned_;
  CandidateGrid grid_;  ///< of all three
  std::set<AgentId> aligned_;
  std::map<AgentId, PeerCandidates> dropped_;
  std::uint64_t redundant_ = 0;
  std::uint64_t crowded_out_ = 0;
};

}  // namespace fleetmap::loop_closure
