#include "fleetmap/fault_injection/failure_report.hpp"

#include <algorithm>
#include <sstream>
#include <utility>

#include "shrink.hpp"

namespace fleetmap::fault_injection {
namespace {

std::string faults_of(const Scenario& scenario, const std::vector<std::size_t>& kept) {
  std::ostringstream out;
  for (const std::size_t k : kept) out << "  fault " << k << ' ' << to_string(scenario.faults[k]) << '\n';
  return out.str();
}

bool violates(const Outcome& outcome, Invariant invariant) {
  return std::ranges::any_of(outcome.violations,
                             [&](const Violation& violation) { return violation.invariant == invariant; });
}

}  // namespace

Scenario with_faults(Scenario scenario, const std::vector<std::size_t>& kept) {
  std::vector<Fault> faults;
  for (const std::size_t k : kept) faults.push_back(scenario.faults.at(k));
  scenario.faults = std::move(faults);
  return scenario;
}

std::string failure_report(const Scenario& scenario, const Outcome& outcome, const RunConfig& config,
                           bool shrinks) {
  std::ostringstream out;
  out << "seed " << scenario.seed << ", " << scenario.robots << " robots:\n";
  for (const Violation& violation : outcome.violations) out << "  violates " << to_string(violation) << '\n';
  if (!shrinks) return out.str();
  const Invariant invariant = outcome.violations.front().invariant;
  const auto kept = shrink(scenario.faults.size(), [&](const std::vector<std::size_t>& subset) {
    return violates(run(with_faults(scenario, subset), config), invariant);
  });
  out << "  " << to_string(invariant) << " fails with " << kept.size() << " of " << scenario.faults.size()
      << " faults:\n"
      << faults_of(scenario, kept) << "  fleetmap fuzz-fleet --replay " << scenario.seed;
  for (std::size_t k = 0; k < kept.size(); ++k) out << (k == 0 ? " --keep " : ",") << kept[k];
  if (config.signatures) out << " --signatures";
  out << '\n';
  return out.str();
}

}  // namespace fleetmap::fault_injection
