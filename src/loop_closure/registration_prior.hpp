#pragma once

#include <optional>

#include "fleetmap/graph/node.hpp"
#include "fleetmap/loop_closure/candidate_config.hpp"
#include "fleetmap/loop_closure/loop_candidate.hpp"
#include "fleetmap/registration/register_clouds.hpp"

namespace fleetmap::loop_closure {

/// The prior of T_target_source from both G, with the uncertainty of both.
registration::Prior position_prior(const GlobalPose& target, const GlobalPose& source);

/// The prior with which the clouds of a candidate are registered:
///
/// - its own T_target_source, if it has one. That of an inter-frame transform is widened to the sigma of a
///   good GPS, so that the search window contains the neighbouring rows and posts too: if the transform is
///   one row off, the right pose is still among the modes;
///
/// - else both G, if neither's horizontal sigma exceeds CandidateConfig::max_sigma_m;
///
/// - else the descriptor match, if it reaches DescriptorMatchConfig::min_similarity.
std::optional<registration::Prior> registration_prior(const LoopCandidate& candidate,
                                                      const graph::Node& target, const graph::Node& source,
                                                      const CandidateConfig& config);

}  // namespace fleetmap::loop_closure
