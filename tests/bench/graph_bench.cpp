// CPU of an update of the fleet's robust pose graph with the covariance of the newest node, at several sizes,
// and what the paper's scheme takes on the same set in the same run. A third of the false alignments are one
// row off and agree with each other, the others are metres off anywhere.

#include <algorithm>
#include <cstdio>
#include <limits>

#include "fleetmap/core/cpu_time.hpp"
#include "fleetmap/graph/compute_placement.hpp"
#include "graph/simulated_fleet.hpp"
#include "paper_placement.hpp"

namespace {

using namespace fleetmap;
using graph::testing::SimulatedFleet;

template <class Run>
double best_of(int times, const Run& run) {
  double best = std::numeric_limits<double>::infinity();
  for (int k = 0; k < times; ++k) {
    const double start = thread_cpu_seconds();
    run();
    best = std::min(best, thread_cpu_seconds() - start);
  }
  return best;
}

void measure(int robots, int nodes_each, int every, double false_share) {
  graph::testing::SimulatedFleetConfig mission = graph::testing::long_mission(robots, nodes_each);
  mission.filtered = true;  // G as an EKF makes it of fixes
  SimulatedFleet fleet(1, mission);
  const auto false_ones = fleet.align_neighbours(every, false_share);
  graph::PlacementConfig fleet_mode;
  fleet_mode.method = graph::PlacementMethod::graph;
  const NodeId newest = fleet.nodes.back().id;
  graph::Placement placement;
  const double fleet_s = best_of(3, [&] {
    placement = graph::compute_placement(fleet.nodes, fleet.alignments, fleet.site, fleet_mode, {&newest, 1});
  });
  const double paper_s =
      best_of(3, [&] { graph::place_by_min_rmse(fleet.nodes, fleet.alignments, fleet.site); });
  const auto wrong = std::ranges::count_if(placement.used, [&](const graph::Alignment& a) {
    return false_ones.contains({a.computed_by, a.seq});
  });
  std::printf("| %zu | %d | %zu | %zu | %zu | %td | %.1f | %.1f | %.2f |\n", fleet.nodes.size(), robots,
              fleet.alignments.size(), false_ones.size(), placement.used.size(), wrong, 1e3 * fleet_s,
              1e3 * paper_s, fleet_s / paper_s);
}

}  // namespace

int main() {
  std::printf(
      "| nodes | robots | alignments | false | used | false used | fleet, CPU ms | paper, CPU ms | ratio "
      "|\n");
  std::printf("|---|---|---|---|---|---|---|---|---|\n");
  measure(5, 200, 10, 0.0);
  measure(5, 200, 10, 0.2);
  measure(5, 2'000, 10, 0.2);
  measure(10, 5'000, 20, 0.0);
  measure(10, 5'000, 20, 0.2);
  measure(10, 5'000, 10, 0.2);
}
