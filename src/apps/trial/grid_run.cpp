#include "grid_run.hpp"

#include <unistd.h>

#include <fstream>
#include <iterator>
#include <ostream>
#include <string>
#include <vector>

#include "fleetmap/config/experiment_file.hpp"
#include "fleetmap/core/bytes.hpp"
#include "fleetmap/experiment/experiment.hpp"
#include "fleetmap/experiment/grid.hpp"
#include "fleetmap/experiment/progress_line.hpp"
#include "options.hpp"
#include "version.hpp"

namespace fleetmap::apps {
namespace {

/// Version, commit and hash of the program that is running: another build may give other numbers.
std::string this_program() {
  std::ifstream in("/proc/self/exe", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  const ContentHash hash = content_hash({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  return std::string(kVersion) + " " + to_hex(hash).substr(0, 16);
}

CommandResult<ExitCode> run_single(const std::vector<experiment::Case>& cases, const std::string& name,
                                   const experiment::Engine& engine, const experiment::RunnerConfig& runner,
                                   const std::atomic<bool>& stop, std::ostream& out) {
  const auto index = experiment::case_named(cases, name);
  if (!index) return exit_with(kUsage, {"--case " + index.error().message});
  const auto record = experiment::run_single_case(cases, *index, engine, runner, stop);
  if (!record) return exit_with(kFailed, record.error());
  if (!record->done()) return exit_with(kFailed, {name + ": " + record->reason});
  out << name << (record->reused ? ": was done already, in " : ": done in ")
      << experiment::duration_text(record->wall_seconds) << ", "
      << (runner.folder(record->folder) / "result.json").string() << '\n';
  return kDone;
}

}  // namespace

CommandResult<ExitCode> run_grid(const GridOptions& options, const MakeEngine& make_engine,
                                 std::ostream& out) {
  const auto overrides = parse_overrides(options.set);
  if (!overrides) return exit_with(kUsage, overrides.error());
  const auto grid = experiment::load_grid(options.config, options.quick, *overrides);
  if (!grid) return exit_with(kBadConfiguration, grid.error());
  if (options.list) {
    const Status listed = experiment::list_cases(grid->cases, out);
    return listed ? CommandResult<ExitCode>(kDone) : exit_with(kBadConfiguration, listed.error());
  }

  const std::atomic<bool>& stop = stop_on_signals();
  const experiment::Engine engine = make_engine(stop);
  const experiment::RunnerConfig runner{options.out, options.jobs, options.keep, this_program(),
                                        options.any_build};
  if (!options.one_case.empty()) return run_single(grid->cases, options.one_case, engine, runner, stop, out);
  const auto result = options.report ? experiment::report_experiment(grid->config, runner, out)
                                     : experiment::run_experiment(grid->config, engine, runner, stop, out,
                                                                  ::isatty(STDOUT_FILENO) != 0);
  if (!result) return exit_with(kFailed, result.error());
  if (!result->outcome.complete()) {
    out << "incomplete: " << result->outcome.missing.size() << " runs are still to be made"
        << (options.report ? "\n" : "; the same command goes on from here\n");
  }
  return result->good() ? kDone : kFailed;
}

}  // namespace fleetmap::apps
