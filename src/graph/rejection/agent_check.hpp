#pragma once

#include <optional>

#include "rejection/prior_evidence.hpp"

namespace fleetmap::graph {

/// The one agent without whose hypotheses the best ones of all frame pairs agree with each other, GPS and
/// odometry, if with them they do not: the agent whose absence makes the rest a thousand times as likely as
/// that of any other agent or of any single hypothesis does. None if there is no such agent, or if most of
/// its hypotheses agree with the others: an honest robot's false registrations differ in cause, those of a
/// compromised one are all its own. Leaving out one source after the other is how GPS receivers find a faulty
/// satellite (RAIM; Parkinson and Axelrad, NAVIGATION 35(2), 1988).
std::optional<AgentId> contradicting_agent(const RejectionProblem& problem, const PriorEvidence& evidence,
                                           const SolvedGraph& prior);

}  // namespace fleetmap::graph
