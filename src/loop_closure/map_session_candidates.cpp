#include "map_session_candidates.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "descriptor_candidates.hpp"
#include "fleetmap/place/ball_tree.hpp"
#include "fleetmap/place/proximity_search.hpp"

namespace fleetmap::loop_closure {
namespace {

using Side = DescriptorCandidates::Side;

bool located(const graph::Node& node, const CandidateConfig& config) {
  return place::has_known_position(node.G, config.max_sigma_m);
}

void add_by_position(const Track& targets, const Track& sources, const CandidateConfig& config,
                     MapSessionCandidates& found) {
  place::BallTree tree;
  Track in_tree;
  for (const graph::Node* target : targets) {
    if (!located(*target, config) || tree.insert(target->G->position) == place::BallTree::kRefused) continue;
    in_tree.push_back(target);
  }
  for (const graph::Node* source : sources) {
    if (!located(*source, config)) continue;
    if (const auto nearest = tree.nearest(source->G->position))
      found.nearest_m = std::min(found.nearest_m.value_or(nearest->distance), nearest->distance);
    const auto near = place::find_proximity(tree, *source->G, config.proximity);
    if (!near) continue;
    found.candidates.push_back({in_tree[near->nearest.index]->id, source->id,
                                LoopCandidate::Origin::kPosition, near->nearest.distance, near->radius});
  }
}

void add_by_descriptor(const Track& targets, const Track& sources, const CandidateConfig& config,
                       MapSessionCandidates& found) {
  DescriptorCandidates descriptors(config.descriptors, config.proximity.max_radius);
  for (const graph::Node* target : targets)
    descriptors.propose(*target, located(*target, config), Side::kOurs);
  for (const graph::Node* source : sources) {
    const auto matches = descriptors.propose(*source, located(*source, config), Side::kTheirs);
    found.candidates.insert(found.candidates.end(), matches.begin(), matches.end());
  }
}

/// Keeps a candidate unless one before it lies within the spacing at both ends.
std::vector<LoopCandidate> spaced(const std::vector<LoopCandidate>& candidates,
                                  const std::map<NodeId, const graph::Node*>& nodes, double spacing) {
  const auto near = [&](const NodeId& a, const NodeId& b) {
    return (nodes.at(a)->T_odom_base.translation() - nodes.at(b)->T_odom_base.translation()).norm() < spacing;
  };
  std::vector<LoopCandidate> kept;
  for (const LoopCandidate& candidate : candidates) {
    const bool redundant = std::ranges::any_of(kept, [&](const LoopCandidate& other) {
      return near(candidate.target, other.target) && near(candidate.source, other.source);
    });
    if (!redundant) kept.push_back(candidate);
  }
  return kept;
}

}  // namespace

MapSessionCandidates candidates_between(const Track& targets, const Track& sources,
                                        const CandidateConfig& config) {
  MapSessionCandidates found;
  add_by_position(targets, sources, config, found);
  add_by_descriptor(targets, sources, config, found);
  // Descriptor matches come last, those of the best score first.
  std::ranges::sort(found.candidates, {}, [](const LoopCandidate& candidate) {
    const bool matched = candidate.origin == LoopCandidate::Origin::kDescriptor;
    return std::tuple(matched, matched ? -candidate.match_score : candidate.distance, candidate.target,
                      candidate.source);
  });
  std::map<NodeId, const graph::Node*> nodes;
  for (const Track* track : {&targets, &sources}) {
    for (const graph::Node* node : *track) nodes.emplace(node->id, node);
  }
  found.candidates = spaced(found.candidates, nodes, config.spacing_m);
  return found;
}

}  // namespace fleetmap::loop_closure
