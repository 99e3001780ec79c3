#include "fleetmap/fault_injection/scenario.hpp"

#include <algorithm>
#include <sstream>

#include "draws.hpp"

namespace fleetmap::fault_injection {
namespace {

constexpr std::uint64_t kScenarioStream = 1;
constexpr double kRare = 0.15;  ///< share of faults that cost much CPU

/// `count` of the robots, in random order.
std::vector<std::size_t> pick(Draws& draws, std::size_t robots, std::size_t count) {
  std::vector<std::size_t> all(robots);
  for (std::size_t k = 0; k < robots; ++k) all[k] = k;
  for (std::size_t k = 0; k < count; ++k) std::swap(all[k], all[k + draws.below(robots - k)]);
  all.resize(count);
  return all;
}

std::size_t concerned(Draws& draws, FaultKind kind, std::size_t robots) {
  switch (kind) {
    case FaultKind::kLoss:
    case FaultKind::kDelay:
    case FaultKind::kDuplication:
      return draws.chance(0.5) ? 0 : 1;
    case FaultKind::kOneWay:
      return 2;
    case FaultKind::kPartition:
      return 1 + draws.below(robots - 1);
    case FaultKind::kStranger:
    case FaultKind::kForged:
      return 0;
    default:
      return 1;
  }
}

double draw_value(Draws& draws, FaultKind kind) {
  switch (kind) {
    case FaultKind::kLoss:
      return draws.between(0.05, 0.6);
    case FaultKind::kDelay:
      return draws.chance(0.3) ? draws.between(1.0, 10.0) : draws.between(0.1, 1.0);
    case FaultKind::kDuplication:
      return draws.between(0.05, 0.5);
    case FaultKind::kOldStore:
      return draws.between(2.0, 90.0);
    case FaultKind::kDamagedStore:
      return draws.uniform();
    case FaultKind::kManyStarts:
      return static_cast<double>(draws.chance(kRare) ? 300 + draws.below(100) : 2 + draws.below(20));
    case FaultKind::kClockStep:
      return draws.between(-7200.0, 7200.0);
    case FaultKind::kStranger:
    case FaultKind::kForged:
      return draws.between(0.2, 10.0);
    default:
      return 0.0;
  }
}

/// The invariants hold for one compromised member: all such faults concern the robot of the first.
void one_compromised(Scenario& scenario) {
  const auto is_one = [](const Fault& fault) { return fault.kind == FaultKind::kCompromised; };
  const auto first = std::ranges::find_if(scenario.faults, is_one);
  for (Fault& fault : scenario.faults)
    if (is_one(fault)) fault.robots = first->robots;
}

}  // namespace

Scenario make_scenario(std::uint64_t seed, const ScenarioConfig& config) {
  Draws draws(seed, kScenarioStream);
  Scenario scenario{seed, 0, config.mapping, {}};
  scenario.robots = config.min_robots + draws.below(config.max_robots - config.min_robots + 1);
  const std::vector<FaultKind> kinds(config.kinds.begin(), config.kinds.end());
  const std::size_t count = kinds.empty() ? 0 : 1 + draws.below(config.max_faults);
  const double mapping = to_seconds(config.mapping);
  for (std::size_t k = 0; k < count; ++k) {
    Fault fault;
    fault.kind = kinds[draws.below(kinds.size())];
    fault.begin = from_seconds(draws.between(0.0, 0.95 * mapping));
    fault.length = from_seconds(draws.between(1.0, 0.5 * mapping));
    fault.robots = pick(draws, scenario.robots, concerned(draws, fault.kind, scenario.robots));
    fault.value = draw_value(draws, fault.kind);
    if (impairs_links(fault.kind)) {
      const double link = draws.uniform();
      fault.radio = link < 0.7;
      fault.short_range = link < 0.4 || link >= 0.7;
    }
    scenario.faults.push_back(fault);
  }
  std::ranges::stable_sort(scenario.faults, {}, &Fault::begin);
  one_compromised(scenario);
  return scenario;
}

}  // namespace fleetmap::fault_injection
