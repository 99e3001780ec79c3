#include "fleetmap/loop_closure/map_sessions.hpp"

#include <algorithm>
#include <utility>

#include "fleetmap/loop_closure/registered_alignment.hpp"
#include "fleetmap/loop_closure/submap_drift.hpp"
#include "map_session_candidates.hpp"
#include "own_clouds.hpp"
#include "registration_prior.hpp"

namespace fleetmap::loop_closure {
namespace {

Track track_of(const store::Store& store, const graph::FrameId& frame) {
  const std::uint32_t first = first_seq(frame.session);
  return store.nodes_from({frame.agent, first, first + kItemsPerSession});
}

class MapSessionAlignment {
 public:
  MapSessionAlignment(store::Store& store, const MapSessionConfig& config)
      : store_(store), config_(config), clouds_(config.spherize) {}

  void join(const graph::FrameId& target, const graph::FrameId& source) {
    const MapSessionCandidates between =
        candidates_between(track_of(store_, target), track_of(store_, source), config_.candidates);
    if (between.nearest_m)
      done_.nearest_m = std::min(done_.nearest_m.value_or(*between.nearest_m), *between.nearest_m);
    done_.candidates += between.candidates.size();
    for (const LoopCandidate& candidate : between.candidates) close(candidate);
  }
  MapSessionAlignments take() { return std::move(done_); }

 private:
  void close(const LoopCandidate& candidate) {
    const auto result = registered(candidate);
    if (!result) return reject(result.error().message);
    using registration::Verdict;
    if (result->verdict == Verdict::rejected) return reject(result->reason);
    ++(result->verdict == Verdict::accepted ? done_.accepted : done_.ambiguous);
    done_.found.push_back(alignment_of(candidate.target, candidate.source, candidate.target.agent, *result));
  }
  void reject(const std::string& reason) { ++done_.rejected[reason]; }

  Result<registration::RegistrationResult> registered(const LoopCandidate& candidate) {
    const graph::Node& target = *store_.node(candidate.target);
    const graph::Node& source = *store_.node(candidate.source);
    const auto prior = registration_prior(candidate, target, source, config_.candidates);
    if (!prior) return failure("there is no prior for their relative pose");
    const auto target_cloud = clouds_.of(store_, target)->prepared(config_.registration);
    if (!target_cloud) return tl::unexpected(target_cloud.error());
    const auto source_cloud = clouds_.of(store_, source)->prepared(config_.registration);
    if (!source_cloud) return tl::unexpected(source_cloud.error());
    const registration::Drifts drifts{drift_around(store_, target, config_.spherize.radius_m),
                                      drift_around(store_, source, config_.spherize.radius_m)};
    return registration::register_clouds(*target_cloud, *source_cloud, config_.registration, *prior, drifts);
  }

  store::Store& store_;
  const MapSessionConfig& config_;
  OwnClouds clouds_;
  MapSessionAlignments done_;
};

}  // namespace

MapSession map_session_of(const store::Store& store) {
  MapSession session;
  for (const auto& [id, node] : store.nodes()) session.insert(node.frame());
  return session;
}

MapSessionAlignments align_map_sessions(store::Store& store, const MapSession& earlier,
                                        const MapSession& later, const MapSessionConfig& config) {
  MapSessionAlignment alignment(store, config);
  for (const graph::FrameId& target : earlier) {
    for (const graph::FrameId& source : later) {
      if (!later.contains(target) && !earlier.contains(source)) alignment.join(target, source);
    }
  }
  return alignment.take();
}

}  // namespace fleetmap::loop_closure
