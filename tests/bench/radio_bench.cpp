// Measures fleets of 5 to 50 robots on one radio, in virtual time: the table of exchanges alone in
// docs/results/field.md.
//   bench_radio [ROBOTS...]    these alone
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "exchange/sim_fleet.hpp"

namespace {

using namespace fleetmap;
using messages::Reach;
using testing::SimFleet;

struct Case {
  std::size_t robots;
  std::size_t groups = 1;  ///< each on a radio of its own
  bool multicast = false;
};

constexpr int kNodes = 40;                             // of each robot
constexpr auto kNodePeriod = std::chrono::seconds(3);  // at 1.3 m/s
constexpr double kSpacing = 4.0;                       // m
constexpr double kTrackStep = 40.0;  // m: tracks of 160 m, each along those of the next three robots
constexpr auto kMaxWait = std::chrono::minutes(20);  // for equal sets
constexpr Duration kWindow = std::chrono::seconds(10);

std::size_t robot_number(const AgentId& name) { return std::stoul(name.str().substr(1)) - 1; }

/// On the radio, with headers.
struct Bytes {
  double all = 0.0, nodes = 0.0, clouds = 0.0;
};

Bytes bytes_of(const SimFleet& fleet) {
  Bytes bytes;
  for (const auto& sent : fleet.sent()) {
    if (sent.outgoing.reach != Reach::kLongRange) continue;
    const auto size = static_cast<double>(sent.wire_bytes);
    bytes.all += size;
    if (std::holds_alternative<graph::Node>(sent.outgoing.message)) bytes.nodes += size;
    if (std::holds_alternative<messages::CloudFragment>(sent.outgoing.message)) bytes.clouds += size;
  }
  return bytes;
}

std::size_t group_of(const Case& wanted, const AgentId& name) {
  return robot_number(name) / (wanted.robots / wanted.groups);
}

/// All robots make their nodes; the stamps of these.
std::map<NodeId, Stamp> make_nodes(SimFleet& fleet, const std::vector<std::string>& names) {
  std::map<NodeId, Stamp> made;
  for (int k = 0; k < kNodes; ++k) {
    for (std::size_t robot = 0; robot < names.size(); ++robot) {
      const double place = kTrackStep * static_cast<double>(robot) + kSpacing * k;
      made[fleet.add_node(names[robot], place).id] = fleet.now();
    }
    fleet.run_for(kNodePeriod);
  }
  return made;
}

/// Share of the nodes that the robots of their group hold, of those made at least kWindow ago.
double share_held(const SimFleet& fleet, const Case& wanted, const std::map<NodeId, Stamp>& made) {
  double held = 0.0, all = 0.0;
  for (const auto& [id, at] : made) {
    if (fleet.now() - at < kWindow) continue;
    for (const auto& [name, robot] : fleet.robots()) {
      if (group_of(wanted, name) != group_of(wanted, id.agent)) continue;
      all += 1.0;
      held += robot.store->node(id) != nullptr ? 1.0 : 0.0;
    }
  }
  return held / all;
}

void measure(const Case& wanted) {
  std::vector<std::string> names;
  for (std::size_t k = 1; k <= wanted.robots; ++k) names.push_back("r" + std::to_string(k));
  const std::size_t group_size = wanted.robots / wanted.groups;
  SimFleet fleet(names, {}, 3,
                 [&](exchange::ExchangeConfig& config) { config.long_range.multicast = wanted.multicast; });
  bool met = false;  // r1 then drives across, and whom it meets passes on what it brings
  fleet.reachable = [&](const AgentId& from, const AgentId& to, Reach reach) {
    if (reach == Reach::kLongRange) return group_of(wanted, from) == group_of(wanted, to);
    return met && (robot_number(from) == 0 || robot_number(to) == 0);
  };
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (wanted.groups > 1) {
      fleet.share_radio(std::span(names).subspan(k / group_size * group_size, group_size));
    }
    fleet.start(names[k]);
  }
  const Stamp begun = fleet.now();
  const std::map<NodeId, Stamp> made = make_nodes(fleet, names);
  const double held = share_held(fleet, wanted, made);
  const Bytes bytes = bytes_of(fleet);
  const double radio =
      bytes.all * 8.0 / 1000.0 / to_seconds(fleet.now() - begun) / static_cast<double>(wanted.groups);
  std::size_t clouds = 0;
  for (const auto& [name, robot] : fleet.robots()) clouds += robot.received.size();
  met = wanted.groups > 1;
  const Stamp end = fleet.now();
  const std::size_t nodes = made.size();
  fleet.forget_sent();
  fleet.run_for(kMaxWait, [&] {
    if (fleet.sent().size() > 100'000) fleet.forget_sent();
    return fleet.equal_sets(nodes);
  });
  const bool equal = fleet.equal_sets(nodes);
  std::printf("| %zu | %zu%s | %.0f %% | %.0f | %.0f / %.0f | %zu | %s%.0f s |\n", wanted.robots,
              wanted.groups, wanted.multicast ? ", multicast" : "", 100.0 * held, radio,
              100.0 * bytes.nodes / bytes.all, 100.0 * bytes.clouds / bytes.all, clouds,
              equal ? "" : "not in ", to_seconds(fleet.now() - end));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<Case> cases = {{3},  {5},           {8},     {10},          {10, 1, true}, {12},
                                   {20}, {20, 1, true}, {20, 2}, {20, 2, true}, {50},          {50, 5}};
  std::set<std::size_t> wanted;
  for (int k = 1; k < argc; ++k) wanted.insert(std::strtoul(argv[k], nullptr, 10));
  std::printf(
      "| robots | radios | nodes held | kbit/s | nodes / clouds %% | clouds | all equal after "
      "|\n|---|---|---|---|---|---|---|\n");
  for (const Case& one : cases) {
    if (wanted.empty() || wanted.contains(one.robots)) measure(one);
  }
}
