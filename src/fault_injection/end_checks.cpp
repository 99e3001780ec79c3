#include "end_checks.hpp"

#include <algorithm>
#include <cstdio>
#include <string>

#include "fleetmap/graph/contradictions.hpp"
#include "fleetmap/output/placed_store.hpp"
#include "truth_check.hpp"

namespace fleetmap::fault_injection {
namespace {

/// m. A robot that no alignment connects is placed by its GPS alone, whose error is 0.7 m in each axis: five
/// sigma.
constexpr double kGpsError = 3.5;
/// m. The graph accepts alignments that agree with GPS to five sigma, so that a compromised robot can move
/// another one by as much, and two against each other by five sigma of their difference.
constexpr double kBent = 3.5, kMaxTorn = 5.0;

std::string metres(double length) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f m", length);
  return text;
}

void check_truth(const EndInput& input, const AgentId& robot, const graph::Placement& placement,
                 const TruthInput& truth, Monitor& monitor, Outcome& outcome) {
  const TruthErrors errors = truth_errors(placement, truth);
  outcome.largest_error = std::max(outcome.largest_error, errors.largest);
  outcome.torn = std::max(outcome.torn, errors.torn);
  if (errors.largest > kGpsError + (truth.compromised ? kBent : 0.0))
    monitor.note(Invariant::kTruth, robot, input.now,
                 "places " + to_string(errors.worst) + ' ' + metres(errors.largest) + " off");
  if (errors.torn > kMaxTorn)
    monitor.note(Invariant::kTruth, robot, input.now,
                 "places " + to_string(errors.torn_b) + " against " + to_string(errors.torn_a) + ' ' +
                     metres(errors.torn) + " off");
}

void check_named(const EndInput& input, const AgentId& robot, const graph::Placement& placement,
                 const TruthInput& truth, Monitor& monitor) {
  const auto named = graph::contradict_the_fleet(placement, truth.nodes, input.site);
  for (const auto& [agent, contradiction] : named) {
    if (agent != truth.compromised)
      monitor.note(Invariant::kNamed, robot, input.now,
                   "names " + agent.str() + ", which is honest: " + to_string(contradiction));
  }
  if (input.compromised && input.compromised->is_gross && !named.contains(input.compromised->robot))
    monitor.note(Invariant::kNamed, robot, input.now,
                 "does not name " + input.compromised->robot.str() + ", which is compromised");
}

}  // namespace

void check_maps(const EndInput& input, Monitor& monitor, Outcome& outcome) {
  for (const MapDifference& difference : map_differences(input.robots, input.site))
    monitor.note(Invariant::kSameMap, difference.robot, input.now, difference.what);
  if (const std::string what = why_incomplete(input.robots, input.now); !what.empty())
    monitor.note(Invariant::kCompletes, {}, input.now, what);
  if (input.anyone_forges) return;
  // All robots hold the same items, and those of equal items have equal placements.
  const auto& [robot, first] = *input.robots.begin();
  const auto nodes = output::nodes_of(*first.store);
  const auto alignments = output::alignments_of(*first.store);
  TruthInput truth{nodes, alignments, {}, input.site, input.truth};
  if (input.compromised) truth.compromised = input.compromised->robot;
  const graph::Placement placement = placement_of(first, input.site);
  check_truth(input, robot, placement, truth, monitor, outcome);
  check_named(input, robot, placement, truth, monitor);
}

void check_stores(const EndInput& input, Monitor& monitor) {
  for (const auto& [name, robot] : input.robots) {
    monitor.check_held(name, *robot.store, input.now);
    monitor.check_contents(name, *robot.store, input.now);
  }
}

}  // namespace fleetmap::fault_injection
