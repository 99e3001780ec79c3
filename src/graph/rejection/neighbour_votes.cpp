#include "rejection/neighbour_votes.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "rejection/innovation.hpp"

namespace fleetmap::graph {
namespace {

constexpr std::size_t kNeighbours = 2;  // on each side
constexpr int kMinContradictions = 2;

/// Modes of one alignment.
struct Modes {
  Indices at;  ///< indices in the caller's candidates
  std::vector<LinearisedCandidate> candidates;
};

enum class Vote { against, abstains, for_it };  // ordered: the best of an alignment's modes counts

/// Votes of two alignments on each other's modes.
std::array<std::vector<Vote>, 2> mutual_votes(const Modes& a, const Modes& b) {
  std::array<std::vector<Vote>, 2> votes{std::vector<Vote>(a.at.size(), Vote::against),
                                         std::vector<Vote>(b.at.size(), Vote::against)};
  for (std::size_t i = 0; i < a.at.size(); ++i) {
    for (std::size_t j = 0; j < b.at.size(); ++j) {
      const LinearisedCandidate &x = a.candidates[i], &y = b.candidates[j];
      const ConditionalResidual residual = conditional_residual(x, y, BlockCholesky::inner(y.z, x.z));
      if (!residual.is_consistent()) continue;
      const Vote vote = residual.sigma_m > kCertainM ? Vote::abstains : Vote::for_it;
      votes[0][i] = std::max(votes[0][i], vote);
      votes[1][j] = std::max(votes[1][j], vote);
    }
  }
  return votes;
}

/// Alignments in the order of the track, each with its modes.
std::vector<Modes> along_track(std::span<const Candidate> all, std::span<const std::size_t> candidates,
                               const SolvedGraph& solved) {
  Indices order(candidates.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, {}, [&](std::size_t k) {
    return std::pair(position_on_track(all[candidates[k]]), all[candidates[k]].alignment);
  });
  std::vector<Modes> alignments;
  for (const std::size_t k : order) {
    if (alignments.empty() || alignments.back().candidates.front().alignment != all[candidates[k]].alignment)
      alignments.emplace_back();
    alignments.back().at.push_back(k);
    alignments.back().candidates.push_back(linearise(all, candidates[k], solved));
  }
  return alignments;
}

}  // namespace

std::vector<Votes> neighbour_votes(std::span<const Candidate> all, std::span<const std::size_t> candidates,
                                   const SolvedGraph& solved) {
  const std::vector<Modes> alignments = along_track(all, candidates, solved);
  std::vector<Votes> votes(candidates.size());
  for (std::size_t k = 0; k < alignments.size(); ++k) {
    for (std::size_t before = k - std::min(k, kNeighbours); before < k; ++before) {
      const auto mutual = mutual_votes(alignments[before], alignments[k]);
      for (std::size_t side = 0; side < 2; ++side) {
        const Indices& at = alignments[side == 0 ? before : k].at;
        for (std::size_t mode = 0; mode < at.size(); ++mode) {
          votes[at[mode]].consistent += mutual[side][mode] == Vote::for_it;
          votes[at[mode]].contradicting += mutual[side][mode] == Vote::against;
        }
      }
    }
  }
  return votes;
}

std::set<std::size_t> rejected_by_neighbours(std::span<const Candidate> all, const PriorGating& gating,
                                             const SolvedGraph& prior) {
  std::set<std::size_t> rejected;
  for (const auto& [frames, group] : gating.groups) {
    const std::vector<Votes> votes = neighbour_votes(all, group, prior);
    std::set<std::size_t> of_pair;
    for (std::size_t k = 0; k < group.size(); ++k) {
      if (votes[k].contradicting >= kMinContradictions && votes[k].contradicting > votes[k].consistent)
        of_pair.insert(group[k]);
    }
    const bool all_are =
        std::ranges::all_of(gating.compatible.at(frames), [&](std::size_t c) { return of_pair.contains(c); });
    if (!all_are) rejected.merge(of_pair);
  }
  return rejected;
}

}  // namespace fleetmap::graph
