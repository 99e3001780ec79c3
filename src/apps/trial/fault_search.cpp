#include "fault_search.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <iomanip>
#include <ostream>
#include <string>

#include "fleetmap/core/cpu_time.hpp"
#include "fleetmap/fault_injection/failure_report.hpp"
#include "fleetmap/fault_injection/seed_search.hpp"
#include "options.hpp"

namespace fleetmap::apps {
namespace {

using namespace fault_injection;

/// Switches the program's log off while it exists, since the robots log every fault that is injected.
class SilentLog {
 public:
  SilentLog() { spdlog::set_level(spdlog::level::off); }
  ~SilentLog() { spdlog::set_level(before_); }
  SilentLog(const SilentLog&) = delete;
  SilentLog& operator=(const SilentLog&) = delete;

 private:
  spdlog::level::level_enum before_ = spdlog::get_level();
};

CommandResult<ExitCode> replay(const Scenario& scenario, const FuzzOptions& options, RunConfig config,
                               std::ostream& out) {
  if (!options.stores.empty()) {
    if (const Status writable = make_writable(options.stores); !writable)
      return exit_with(kFailed, writable.error());
    config.stores = options.stores;
  }
  const Scenario selected = options.keep.empty() ? scenario : with_faults(scenario, options.keep);
  config.trace = true;
  const Outcome outcome = run(selected, config);
  for (const std::string& line : outcome.trace) out << line << '\n';
  out << selected.robots << " robots, " << outcome.nodes << " nodes, " << outcome.alignments
      << " alignments, " << outcome.packets << " packets, fingerprint " << std::hex << outcome.fingerprint
      << std::dec << '\n'
      << "honest nodes are at most " << outcome.largest_error << " m off, and moved by " << outcome.torn
      << " m against each other by a compromised robot\n";
  for (const Violation& violation : outcome.violations) out << "violates " << to_string(violation) << '\n';
  return outcome.violations.empty() ? kDone : kFailed;
}

CommandResult<ExitCode> search(const FuzzOptions& options, const ScenarioConfig& scenarios,
                               const RunConfig& config, std::ostream& out) {
  const SeedTotals totals =
      try_seeds({options.from, options.seeds, options.jobs, !options.no_shrink}, scenarios, config,
                [&](const std::string& failure) { out << failure << std::flush; });
  out << std::fixed << std::setprecision(1) << options.seeds << " seeds, " << totals.failed << " failed; "
      << totals.nodes << " nodes, " << totals.packets << " packets; the slowest converged after "
      << totals.longest_s << " s, the busiest second had " << totals.max_bytes_per_second << " B; CPU "
      << process_cpu_seconds() << " s\n";
  return totals.failed == 0 ? kDone : kFailed;
}

}  // namespace

CommandResult<ExitCode> search_faults(const FuzzOptions& options, std::ostream& out) {
  const auto kinds = parse_fault_kinds(options.faults);
  if (!kinds) return exit_with(kUsage, kinds.error());
  const auto invariants = parse_invariants(options.invariants);
  if (!invariants) return exit_with(kUsage, invariants.error());
  RunConfig run_config;
  run_config.invariants = *invariants;
  run_config.signatures = options.signatures;
  ScenarioConfig scenarios;
  scenarios.kinds = *kinds;
  scenarios.mapping = from_seconds(options.mapping);
  if (!options.robots.empty()) {
    scenarios.min_robots = *std::ranges::min_element(options.robots);
    scenarios.max_robots = *std::ranges::max_element(options.robots);
  }
  const SilentLog silent;
  if (options.replay) return replay(make_scenario(*options.replay, scenarios), options, run_config, out);
  return search(options, scenarios, run_config, out);
}

}  // namespace fleetmap::apps
