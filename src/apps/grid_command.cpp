#include "grid_command.hpp"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <thread>

#include "commands.hpp"
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

int run_single(const std::vector<experiment::Case>& cases, const std::string& name,
               const experiment::Engine& engine, const experiment::RunnerConfig& runner,
               const std::atomic<bool>& stop) {
  const auto index = experiment::case_named(cases, name);
  if (!index) return report({"--case " + index.error().message}, kUsage);
  const auto record = experiment::run_single_case(cases, *index, engine, runner, stop);
  if (!record) return report(record.error(), kFailed);
  if (!record->done()) return report({name + ": " + record->reason}, kFailed);
  std::cout << name << (record->reused ? ": was done already, in " : ": done in ")
            << experiment::duration_text(record->wall_seconds) << ", "
            << (runner.folder(record->folder) / "result.json").string() << '\n';
  return kDone;
}

}  // namespace

int run_grid(const GridOptions& options, const MakeEngine& make_engine) {
  const auto overrides = parse_overrides(options.set);
  if (!overrides) return report(overrides.error(), kUsage);
  const auto grid = experiment::load_grid(options.config, options.quick, *overrides);
  if (!grid) return report(grid.error(), kBadConfiguration);
  if (options.list) {
    const Status listed = experiment::list_cases(grid->cases, std::cout);
    return listed ? kDone : report(listed.error(), kBadConfiguration);
  }

  const std::atomic<bool>& stop = stop_on_signals();
  const experiment::Engine engine = make_engine(stop);
  const experiment::RunnerConfig runner{options.out, options.jobs, options.keep, this_program(),
                                        options.any_build};
  if (!options.one_case.empty()) return run_single(grid->cases, options.one_case, engine, runner, stop);
  const auto result = options.report ? experiment::report_experiment(grid->config, runner, std::cout)
                                     : experiment::run_experiment(grid->config, engine, runner, stop,
                                                                  std::cout, ::isatty(STDOUT_FILENO) != 0);
  if (!result) return report(result.error(), kFailed);
  if (!result->outcome.complete()) {
    std::cout << "incomplete: " << result->outcome.missing.size() << " runs are still to be made"
              << (options.report ? "\n" : "; the same command goes on from here\n");
  }
  return result->good() ? kDone : kFailed;
}

void add_grid_options(CLI::App& command, GridOptions& options) {
  command
      .add_option("--out", options.out,
                  "folder for results.json, results.csv, tables.md and report.html; a start that was "
                  "interrupted goes on "
                  "where it was")
      ->required()
      ->check(some_path());
  command.add_flag("--quick", options.quick, "the file's quick set: fewer points and seeds");
  command.add_option("--set", options.set, "key=value, a key of every fleet that the studies do not vary")
      ->allow_extra_args(false);
  command.add_flag("--keep", options.keep, "leave stores, maps and recordings of finished cases");
  command.add_flag("--any-build", options.any_build,
                   "take cases that another build of fleetmap has finished, too");
  command.add_flag("--list", options.list, "only print the cases and their keys");
  command
      .add_option("--case", options.one_case,
                  "run only this case, by its name in --list; many processes may do so in one DIR at a time")
      ->check(CLI::Validator(
          [](const std::string& name) {
            return name.empty() ? std::string("is empty; give a name of --list (is a variable unset?)")
                                : std::string();
          },
          "", "name"))
      ->excludes("--list");
  command
      .add_flag("--report", options.report,
                "run nothing: report what is there, and list the cases that are missing")
      ->excludes("--list")
      ->excludes("--case");
}

}  // namespace fleetmap::apps
