#include <spdlog/spdlog.h>

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "commands.hpp"
#include "fleetmap/core/cpu_time.hpp"
#include "fleetmap/fault_injection/failure_report.hpp"
#include "fleetmap/fault_injection/seed_search.hpp"
#include "options.hpp"

namespace fleetmap::apps {
namespace {

using namespace fault_injection;

struct FuzzOptions {
  std::uint64_t seeds = 100;
  std::uint64_t from = 1;
  std::optional<std::uint64_t> replay;
  std::vector<std::size_t> keep;
  std::string stores;
  std::vector<std::size_t> robots;
  std::string faults = "all";
  std::string invariants = "all";
  double mapping = 150.0;
  unsigned jobs = std::max(1u, std::thread::hardware_concurrency());
  bool no_shrink = false;
  bool signatures = false;
};

int replay(const Scenario& scenario, const FuzzOptions& options, RunConfig config) {
  if (!options.stores.empty()) {
    if (const Status writable = make_writable(options.stores); !writable)
      return report(writable.error(), kFailed);
    config.stores = options.stores;
  }
  const Scenario selected = options.keep.empty() ? scenario : with_faults(scenario, options.keep);
  config.trace = true;
  const Outcome outcome = run(selected, config);
  for (const std::string& line : outcome.trace) std::cout << line << '\n';
  std::cout << selected.robots << " robots, " << outcome.nodes << " nodes, " << outcome.alignments
            << " alignments, " << outcome.packets << " packets, fingerprint " << std::hex
            << outcome.fingerprint << std::dec << '\n'
            << "honest nodes are at most " << outcome.largest_error << " m off, and moved by " << outcome.torn
            << " m against each other by a compromised robot\n";
  for (const Violation& violation : outcome.violations)
    std::cout << "violates " << to_string(violation) << '\n';
  return outcome.violations.empty() ? kDone : kFailed;
}

int fuzz(const FuzzOptions& options) {
  const auto kinds = parse_fault_kinds(options.faults);
  if (!kinds) return report(kinds.error(), kUsage);
  const auto invariants = parse_invariants(options.invariants);
  if (!invariants) return report(invariants.error(), kUsage);
  RunConfig run_config;
  run_config.invariants = *invariants;
  run_config.signatures = options.signatures;
  ScenarioConfig config;
  config.kinds = *kinds;
  config.mapping = from_seconds(options.mapping);
  if (!options.robots.empty()) {
    config.min_robots = *std::ranges::min_element(options.robots);
    config.max_robots = *std::ranges::max_element(options.robots);
  }
  if (options.replay) return replay(make_scenario(*options.replay, config), options, run_config);
  const SeedTotals totals =
      try_seeds({options.from, options.seeds, options.jobs, !options.no_shrink}, config, run_config,
                [](const std::string& failure) { std::cout << failure << std::flush; });
  std::cout << std::fixed << std::setprecision(1) << options.seeds << " seeds, " << totals.failed
            << " failed; " << totals.nodes << " nodes, " << totals.packets
            << " packets; the slowest converged after " << totals.longest_s << " s, the busiest second had "
            << totals.max_bytes_per_second << " B; CPU " << process_cpu_seconds() << " s\n";
  return totals.failed == 0 ? kDone : kFailed;
}

}  // namespace

void add_fuzz_fleet(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<FuzzOptions>();
  CLI::App* command = app.add_subcommand(
      "fuzz-fleet", "fleets of random faults in virtual time: finds, replays and shrinks what breaks them");
  command->add_option("--seeds", options->seeds, "fleets to simulate")->check(whole_number(1));
  command->add_option("--from", options->from, "the first seed")->check(whole_number(0));
  command->add_option("--replay", options->replay, "simulates this seed alone and prints what happens")
      ->check(whole_number(0));
  command->add_option("--keep", options->keep, "with --replay: numbers of the faults that happen, e.g. 0,3")
      ->delimiter(',');
  command
      ->add_option("--stores", options->stores,
                   "with --replay: folder for the robots' stores as they end, for `map` and `monitor`")
      ->check(some_path());
  command->add_option("--robots", options->robots, "so many robots; two numbers: between them (3,10)")
      ->delimiter(',')
      ->check(whole_number(2, 20));
  command->add_option("--faults", options->faults, "kinds of faults, separated by commas, or all");
  command->add_option("--invariants", options->invariants,
                      "those that are checked, separated by commas, or all");
  command->add_option("--mapping", options->mapping, "s that the robots map while faults happen")
      ->check(positive_number());
  command->add_option("--jobs", options->jobs, "fleets at a time")->check(whole_number(1, 256));
  command->add_flag("--signatures", options->signatures,
                    "robots sign their items, as a fleet with keys does");
  command->add_flag("--no-shrink", options->no_shrink, "does not look for the fewest faults that fail");
  command->callback([options, &exit_code] {
    spdlog::set_level(spdlog::level::off);  // the robots' own logs of faults that are meant
    exit_code = fuzz(*options);
  });
}

}  // namespace fleetmap::apps
