// Our outlier rejection and the standard remedies on the same pose graphs: four robots on interleaved
// lanes, 1.5 m and 5 m GPS through a filter, alignments between neighbours and of each robot with itself.
// Two thirds of the false alignments are in runs of six that agree with each other (one row or one post off),
// the others are off by metres anywhere. Five seeds each, also of a fleet of ten robots with 50,000 nodes;
// prints false ones kept, true ones lost, both in % of all, joint ATE in m, and CPU ms.

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <set>
#include <string>

#include "fleetmap/core/cpu_time.hpp"
#include "graph/reduced_fleet.hpp"
#include "interpolated_nodes.hpp"
#include "rejection/outlier_rejection.hpp"
#include "standard_rejection.hpp"

namespace {

using namespace fleetmap;
using namespace fleetmap::graph;
using graph::bench::Outcome;
using graph::testing::kPitch;
using graph::testing::ReducedFleet;
using graph::testing::SimulatedFleet;

constexpr unsigned kSeeds = 5;

struct Mission {
  int robots = 4;
  int nodes_each = 250;
  std::uint32_t every = 4;  // own nodes between alignments with one other robot; twice as many with itself
};
constexpr Mission kLargeMission{10, 5'000, 20};

constexpr std::size_t kRun = 6;
constexpr double kPost = 3.0;  // m

using Name = std::pair<AgentId, std::uint32_t>;

struct Pair {
  NodeId i, j;
};

/// Pairs of nodes that see each other, in the order of the track, robots with each other first.
std::vector<std::vector<Pair>> tracks(const SimulatedFleet& fleet, const Mission& mission) {
  std::vector<std::vector<Pair>> tracks;
  const std::uint32_t last = fleet.nodes.back().id.seq;
  for (int r = 0; r + 1 < mission.robots; ++r) {
    auto& track = tracks.emplace_back();
    for (std::uint32_t seq = 0; seq <= last; seq += mission.every)
      track.push_back({{SimulatedFleet::agent(r), seq}, {SimulatedFleet::agent(r + 1), seq}});
  }
  for (int r = 0; r < mission.robots; ++r) {
    auto& track = tracks.emplace_back();
    for (std::uint32_t seq = 0; seq <= last; seq += 2 * mission.every) {
      const NodeId here{SimulatedFleet::agent(r), seq};
      const Node* nearest = nullptr;
      double distance = 1.1 * mission.robots * kPitch;  // the lane before
      for (std::uint32_t other = 0; other + 12 < seq; ++other) {
        const NodeId there{here.agent, other};
        const double d = (fleet.truth.at(here).translation() - fleet.truth.at(there).translation()).norm();
        if (d < distance) nearest = &fleet.node(there), distance = d;
      }
      if (nearest != nullptr) track.push_back({nearest->id, here});
    }
  }
  return tracks;
}

/// Aligns all pairs, a share of them falsely. Returns the names of the false ones.
std::set<Name> align(SimulatedFleet& fleet, const Mission& mission, double false_share) {
  std::set<Name> false_ones;
  for (const std::vector<Pair>& track : tracks(fleet, mission)) {
    const auto n = track.size();
    const auto wanted = static_cast<std::size_t>(std::lround(false_share * static_cast<double>(n)));
    std::vector<Eigen::Vector3d> shifts(n, Eigen::Vector3d::Zero());
    std::size_t done = 0;
    while (done < 2 * wanted / 3) {
      const std::array<Eigen::Vector3d, 4> kinds{Eigen::Vector3d(kPitch, 0, 0),
                                                 Eigen::Vector3d(-kPitch, 0, 0), Eigen::Vector3d(0, kPost, 0),
                                                 Eigen::Vector3d(0, -kPost, 0)};
      const Eigen::Vector3d& shift = kinds[fleet.random()() % kinds.size()];
      const std::size_t first = fleet.random()() % n;
      for (std::size_t k = first; k < std::min(n, first + kRun) && done < 2 * wanted / 3; ++k) {
        if (!shifts[k].isZero()) continue;
        shifts[k] = shift;
        ++done;
      }
    }
    while (done < wanted) {
      Eigen::Vector3d& shift = shifts[fleet.random()() % n];
      if (!shift.isZero()) continue;
      shift = Eigen::Vector3d(fleet.gauss(8.0), fleet.gauss(8.0), fleet.gauss(1.0));
      shift *= (shift.norm() + 3.0) / shift.norm();
      ++done;
    }
    for (std::size_t k = 0; k < n; ++k) {
      const auto& [i, j] = track[k];
      const Alignment& a = fleet.align(i, j, k % 2 == 0 ? i.agent : j.agent, shifts[k]);
      if (!shifts[k].isZero()) false_ones.emplace(a.computed_by, a.seq);
    }
  }
  return false_ones;
}

/// A fleet, and by alignment which mode is right: none of the false ones.
struct Scenario {
  SimulatedFleet fleet;
  std::map<Name, std::size_t> right_mode;
};

/// Robots on interleaved lanes; see the head of the file.
Scenario interleaved(unsigned seed, const Mission& mission, double false_share) {
  graph::testing::SimulatedFleetConfig config =
      graph::testing::long_mission(mission.robots, mission.nodes_each);
  config.filtered = true;
  Scenario scenario{SimulatedFleet(seed, config), {}};
  const std::set<Name> false_ones = align(scenario.fleet, mission, false_share);
  for (const Alignment& a : scenario.fleet.alignments) {
    const Name name(a.computed_by, a.seq);
    if (!false_ones.contains(name)) scenario.right_mode[name] = 0;
  }
  return scenario;
}

/// Three robots that meet each other; all alignments of two of them are one row off.
Scenario false_pair(unsigned seed, double gps_sigma) {
  graph::testing::SimulatedFleetConfig config;
  config.reach = 50.0;
  config.lanes = 6;
  config.length = 80.0;
  config.filtered = true;
  config.gps_sigma = gps_sigma;
  Scenario scenario{SimulatedFleet(seed, config), {}};
  const std::set pair{SimulatedFleet::agent(0), SimulatedFleet::agent(1)};
  for (Alignment& a : scenario.fleet.alignments) {
    if (std::set{a.i.agent, a.j.agent} != pair) {
      scenario.right_mode[{a.computed_by, a.seq}] = 0;
      continue;
    }
    Pose T_enu_j = scenario.fleet.truth.at(a.j);
    T_enu_j.pretranslate(Eigen::Vector3d(kPitch, 0, 0));
    a.modes = {scenario.fleet.observed_at(a.i, T_enu_j)};
  }
  return scenario;
}

/// Three robots; every second alignment has modes at three other rows as well.
Scenario ambiguous(unsigned seed) {
  Scenario scenario{SimulatedFleet(seed), {}};
  for (Alignment& a : scenario.fleet.alignments) {
    std::size_t& right = scenario.right_mode[{a.computed_by, a.seq}] = 0;
    if (scenario.fleet.random()() % 2 == 0) continue;
    for (const double rows : {-1.0, 1.0, 2.0}) {
      Pose T_enu_j = scenario.fleet.truth.at(a.j);
      T_enu_j.pretranslate(Eigen::Vector3d(rows * kPitch, 0, 0));
      a.modes.insert(a.modes.begin(), scenario.fleet.observed_at(a.i, T_enu_j));
      ++right;
    }
  }
  return scenario;
}

/// RMS error of all nodes after a rigid alignment of all robots together.
double joint_ate(const SimulatedFleet& fleet, const ReducedGraph& graph, const Estimate& estimate) {
  const std::vector<Pose> T_enu = interpolated_poses(graph, estimate);
  Eigen::Matrix3Xd placed(3, static_cast<Eigen::Index>(T_enu.size())), truth(placed);
  for (std::size_t k = 0; k < T_enu.size(); ++k) {
    placed.col(static_cast<Eigen::Index>(k)) = T_enu[k].translation();
    truth.col(static_cast<Eigen::Index>(k)) = fleet.truth.at(graph.nodes[k]->id).translation();
  }
  const Eigen::Matrix4d T = Eigen::umeyama(placed, truth, false);
  const Eigen::Matrix3Xd moved = (T.topLeftCorner<3, 3>() * placed).colwise() + T.topRightCorner<3, 1>();
  return std::sqrt((moved - truth).squaredNorm() / static_cast<double>(T_enu.size()));
}

Outcome ours(const ReducedFleet& fleet) {
  Rejection rejection = reject_outliers(fleet.graph, fleet.candidates, fleet.computed_by, fleet.initial);
  Outcome outcome{{}, rejection.estimate};
  for (const Candidate& candidate : fleet.candidates) {
    const auto accepted = rejection.accepted.find(candidate.alignment);
    outcome.kept.push_back(accepted != rejection.accepted.end() &&
                           rejection.candidates[accepted->second].mode == candidate.mode);
  }
  return outcome;
}

/// All candidates between frames between which any is kept.
std::vector<bool> of_joined_frames(const ReducedFleet& fleet, const std::vector<bool>& kept) {
  std::set<FramePair> joined;
  for (std::size_t c = 0; c < kept.size(); ++c)
    if (kept[c]) joined.insert(fleet.candidates[c].frames);
  std::vector<bool> among;
  for (const Candidate& candidate : fleet.candidates) among.push_back(joined.contains(candidate.frames));
  return among;
}

struct Method {
  std::string name;
  std::function<Outcome(const ReducedFleet&, const std::vector<bool>& is_false)> run;
};

std::vector<Method> methods() {
  using namespace graph::bench;
  return {
      {"ours", [](const ReducedFleet& f, const auto&) { return ours(f); }},
      {"PCM", [](const ReducedFleet& f, const auto&) { return pcm(f.graph, f.candidates, f.initial); }},
      {"GNC-TLS",
       [](const ReducedFleet& f, const auto&) {
         return gnc(f.graph, f.candidates, f.initial, std::vector<bool>(f.candidates.size(), true));
       }},
      {"PCM, then GNC-TLS",
       [](const ReducedFleet& f, const auto&) {
         return gnc(f.graph, f.candidates, f.initial, pcm(f.graph, f.candidates, f.initial).kept);
       }},
      {"Cauchy", [](const ReducedFleet& f, const auto&) { return cauchy(f.graph, f.candidates, f.initial); }},
      {"ours, then GNC-TLS",
       [](const ReducedFleet& f, const auto&) {
         return gnc(f.graph, f.candidates, f.initial, of_joined_frames(f, ours(f).kept));
       }},
      {"the true ones",
       [](const ReducedFleet& f, const std::vector<bool>& is_false) {
         std::vector<bool> right = is_false;
         right.flip();
         return least_squares(f.graph, f.candidates, f.initial, right);
       }},
  };
}

struct Sums {
  std::size_t wrong = 0, wrong_kept = 0, right = 0, right_lost = 0;
  double ate = 0.0, seconds = 0.0;
};

struct Condition {
  std::string name;
  std::function<Scenario(unsigned seed)> make;
};

Sums measure(const Method& method, const Condition& condition) {
  Sums sums;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const Scenario scenario = condition.make(seed);
    const ReducedFleet reduced(scenario.fleet);
    std::vector<bool> is_false;
    for (const Candidate& candidate : reduced.candidates) {
      const Alignment& a = *reduced.items.alignments[candidate.alignment];
      const auto right = scenario.right_mode.find({a.computed_by, a.seq});
      is_false.push_back(right == scenario.right_mode.end() || right->second != candidate.mode);
    }
    const double start = thread_cpu_seconds();
    const Outcome outcome = method.run(reduced, is_false);
    sums.seconds += thread_cpu_seconds() - start;
    for (std::size_t k = 0; k < is_false.size(); ++k) {
      ++(is_false[k] ? sums.wrong : sums.right);
      sums.wrong_kept += is_false[k] && outcome.kept[k];
      sums.right_lost += !is_false[k] && !outcome.kept[k];
    }
    sums.ate += joint_ate(scenario.fleet, reduced.graph, outcome.estimate);
  }
  return sums;
}

double percent(std::size_t part, std::size_t all) {
  return all == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(all);
}

}  // namespace

// bench_rejection [METHOD]: one method of the table alone.
int main(int argc, char** argv) {
  std::vector<Condition> conditions;
  for (const int share : {0, 10, 20, 40, 60})
    conditions.push_back({std::to_string(share).append(" % false"),
                          [share](unsigned seed) { return interleaved(seed, {}, 0.01 * share); }});
  for (const char* gps_sigma : {"1.5", "3.0", "5.0"})
    conditions.push_back(
        {std::string("false pair, GPS of ").append(gps_sigma).append(" m"),
         [sigma = std::strtod(gps_sigma, nullptr)](unsigned seed) { return false_pair(seed, sigma); }});
  conditions.push_back({"ambiguous", ambiguous});
  for (const int share : {20, 40})
    conditions.push_back({std::to_string(share).append(" % false of a large fleet"),
                          [share](unsigned seed) { return interleaved(seed, kLargeMission, 0.01 * share); }});
  std::printf(
      "| method | condition | wrong kept | right lost | wrong kept, %% | right lost, %% | ATE, m | CPU, ms "
      "|\n"
      "|---|---|---|---|---|---|---|---|\n");
  for (const Method& method : methods()) {
    if (argc > 1 && method.name != argv[1]) continue;
    for (const Condition& condition : conditions) {
      const Sums sums = measure(method, condition);
      std::printf("| %s | %s | %zu of %zu | %zu of %zu | %.1f | %.1f | %.2f | %.1f |\n", method.name.c_str(),
                  condition.name.c_str(), sums.wrong_kept, sums.wrong, sums.right_lost, sums.right,
                  percent(sums.wrong_kept, sums.wrong), percent(sums.right_lost, sums.right),
                  sums.ate / kSeeds, 1e3 * sums.seconds / kSeeds);
    }
  }
}
