#include "rejection/outlier_rejection.hpp"

#include <utility>

#include "rejection/agent_check.hpp"
#include "rejection/alignment_statuses.hpp"
#include "rejection/loop_check.hpp"
#include "rejection/neighbour_votes.hpp"
#include "rejection/quarantine.hpp"

namespace fleetmap::graph {
namespace {

constexpr int kMaxQuarantineRounds = 3;

/// A solver for the graph with any of the candidates that are not gated out; none if there are none.
std::optional<GraphSolver> solver_with_candidates(const RejectionProblem& problem,
                                                  const PriorGating& gating) {
  std::vector<GraphSolver::Ends> pairs;
  for (const auto& [frames, group] : gating.groups) {
    for (const std::size_t c : group)
      pairs.emplace_back(problem.candidates[c].factor.a, problem.candidates[c].factor.b);
  }
  if (pairs.empty()) return std::nullopt;
  return GraphSolver(problem.graph, pairs);
}

std::map<AgentId, std::size_t> by_agent(const std::map<std::size_t, std::size_t>& accepted,
                                        std::span<const AgentId> computed_by) {
  std::map<AgentId, std::size_t> counts;
  for (const auto& [alignment, candidate] : accepted) ++counts[computed_by[alignment]];
  return counts;
}

/// Steps 1 to 5, or 1 to 3 if `checks_agents` and an agent contradicts the others.
Rejection reject_once(const ReducedGraph& graph, std::vector<Candidate> candidates, const Estimate& initial,
                      bool checks_agents) {
  Rejection result;
  result.candidates = std::move(candidates);
  result.estimate = initial;
  const RejectionProblem problem{graph, result.candidates};
  GraphSolver prior_solver(graph, {});
  Estimate prior_estimate = initial;
  if (prior_solver.solve(prior_estimate, kMaxSteps) != GraphSolver::Outcome::converged) {
    result.solvable = false;
    return result;
  }
  prior_solver.invert(ends_of(problem.candidates));
  const SolvedGraph prior{prior_solver, prior_estimate};

  PriorGating gating = gate_by_prior(problem.candidates, prior);
  std::set<std::size_t> rejected = rejected_by_neighbours(problem.candidates, gating, prior);
  const PriorEvidence evidence =
      prior_evidence(problem.candidates, std::move(gating), std::move(rejected), prior);
  if (checks_agents) result.contradicting = contradicting_agent(problem, evidence, prior);
  if (result.contradicting) return result;
  std::optional<GraphSolver> solver = solver_with_candidates(problem, evidence.gating);
  const LoopCheck nothing_joined{{}, {.solved = true, .estimate = prior_estimate}};
  LoopCheck check = nothing_joined;
  if (solver) {
    JoinedFrames joined = join_frames(problem, evidence, {}, prior_estimate, *solver);
    check = check_loops(problem, evidence, prior, std::move(joined), *solver);
  }
  if (!check.joined.solved) check = nothing_joined;

  result.rejected = rejected_statuses(problem.candidates, evidence, check);
  result.accepted = std::move(check.joined.accepted);
  result.estimate = std::move(check.joined.estimate);
  if (check.repeated && !result.accepted.empty()) {
    // The last trial may not be the one that was kept.
    solver->set_alignments(factors_of(problem.candidates, result.accepted));
    solver->factor_at(result.estimate);
  }
  GraphSolver& last = result.accepted.empty() ? prior_solver : *solver;
  if (last.solved()) result.solver = std::move(last);
  return result;
}

std::vector<Candidate> without_agent(const ReducedGraph& graph, std::vector<Candidate> candidates,
                                     const AgentId& agent) {
  std::erase_if(candidates, [&](const Candidate& c) {
    return graph.frames[c.frames.first].id.agent == agent || graph.frames[c.frames.second].id.agent == agent;
  });
  return candidates;
}

}  // namespace

Rejection reject_outliers(const ReducedGraph& graph, std::vector<Candidate> candidates,
                          std::span<const AgentId> computed_by, const Estimate& initial) {
  std::map<AgentId, std::size_t> sets;
  std::set<AgentId> quarantined;
  std::optional<AgentId> contradicting;
  for (int round = 0;; ++round) {
    Rejection result = reject_once(graph, candidates, initial, !contradicting);
    if (result.contradicting) {
      contradicting = std::move(result.contradicting);
      candidates = without_agent(graph, std::move(candidates), *contradicting);
      result = reject_once(graph, candidates, initial, false);
    }
    result.contradicting = contradicting;
    const auto of_round =
        outlier_sets(graph, result.candidates, result.rejected, computed_by, result.estimate);
    const std::set<AgentId> found = to_quarantine(of_round, by_agent(result.accepted, computed_by));
    for (const auto& [agent, count] : of_round) sets[agent] = count;
    if (found.empty() || round == kMaxQuarantineRounds) {
      result.outlier_sets = std::move(sets);
      result.quarantined = std::move(quarantined);
      return result;
    }
    quarantined.insert(found.begin(), found.end());
    std::erase_if(candidates, [&](const Candidate& c) { return found.contains(computed_by[c.alignment]); });
  }
}

}  // namespace fleetmap::graph
