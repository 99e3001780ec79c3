#include "fleetmap/fault_injection/seed_search.hpp"

#include <algorithm>
#include <mutex>

#include "fleetmap/core/thread_pool.hpp"
#include "fleetmap/fault_injection/failure_report.hpp"
#include "fleetmap/fault_injection/fleet_run.hpp"

namespace fleetmap::fault_injection {

SeedTotals try_seeds(const SeedRange& seeds, const ScenarioConfig& scenarios, const RunConfig& config,
                     const std::function<void(const std::string&)>& on_failure) {
  std::mutex mutex;  // guards totals and on_failure
  SeedTotals totals;
  const auto try_seed = [&](std::uint64_t seed) {
    const Scenario scenario = make_scenario(seed, scenarios);
    const Outcome outcome = run(scenario, config);
    const std::string failure =
        outcome.violations.empty() ? std::string() : failure_report(scenario, outcome, config, seeds.shrinks);
    const std::lock_guard lock(mutex);
    totals.longest_s = std::max(totals.longest_s, to_seconds(outcome.converged_after));
    totals.max_bytes_per_second = std::max(totals.max_bytes_per_second, outcome.max_bytes_per_second);
    totals.nodes += outcome.nodes;
    totals.packets += outcome.packets;
    if (failure.empty()) return;
    ++totals.failed;
    on_failure(failure);
  };
  {
    ThreadPool threads(seeds.jobs);
    for (std::uint64_t k = 0; k < seeds.count; ++k)
      threads.run([&, seed = seeds.first + k] { try_seed(seed); });
  }
  return totals;
}

}  // namespace fleetmap::fault_injection
