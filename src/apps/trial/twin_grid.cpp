#include "twin_grid.hpp"

#include <algorithm>
#include <thread>

#include "fleetmap/experiment/run_case.hpp"
#include "grid_run.hpp"

namespace fleetmap::apps {

CommandResult<ExitCode> run_grid_in_twin(const GridOptions& options, std::ostream& out) {
  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  const MakeEngine engine = [&](const std::atomic<bool>& stop) {
    return experiment::ChildEngine(stop, std::max(1U, cores / options.jobs));
  };
  return run_grid(options, engine, out);
}

}  // namespace fleetmap::apps
