#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <thread>

#include "commands.hpp"
#include "experiment/experiment.hpp"
#include "experiment/run_case.hpp"
#include "fleetmap/core/bytes.hpp"
#include "options.hpp"

namespace fleetmap::apps {
namespace {

struct ExperimentOptions {
  std::string config;
  std::string out;
  std::vector<std::string> set;
  bool quick = false;
  bool keep = false;
  bool any_build = false;
  bool list = false;
  unsigned jobs = std::max(1U, std::thread::hardware_concurrency());
};

/// Version and hash of the program that is running: another build may give other numbers.
std::string this_program() {
  std::ifstream in("/proc/self/exe", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  const ContentHash hash = content_hash({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  return std::string(FLEETMAP_VERSION) + " " + to_hex(hash).substr(0, 16);
}

int list_cases(const std::vector<experiment::Case>& cases) {
  for (const experiment::Case& one : cases) {
    std::cout << one.name << ": " << one.agents << " robots";
    for (const config::Override& entry : one.overrides)
      std::cout << " --set " << entry.key << '=' << entry.value;
    std::cout << '\n';
  }
  return kDone;
}

int run(const ExperimentOptions& options) {
  auto config = config::load_experiment(options.config, options.quick);
  if (!config) return report(config.error(), kBadConfiguration);
  const auto overrides = parse_overrides(options.set);
  if (!overrides) return report(overrides.error(), kUsage);
  for (config::Study& study : config->studies)
    study.overrides.insert(study.overrides.end(), overrides->begin(), overrides->end());
  const std::vector<experiment::Case> cases = experiment::all_cases(*config);
  // What cannot be read with a point's keys is found before hours are spent on the others.
  if (const Status valid = experiment::check_cases(cases); !valid)
    return report(valid.error(), kBadConfiguration);
  if (options.list) return list_cases(cases);

  const std::atomic<bool>& stop = stop_on_signals();
  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  const experiment::ChildEngine engine(stop, std::max(1U, cores / options.jobs));
  const experiment::RunnerConfig runner{options.out, options.jobs, options.keep, this_program(),
                                        options.any_build};
  const auto result =
      experiment::run_experiment(*config, engine, runner, stop, std::cout, ::isatty(STDOUT_FILENO) != 0);
  if (!result) return report(result.error(), kFailed);
  if (result->outcome.interrupted) {
    std::cout << "interrupted after " << result->outcome.records.size() << " of " << result->outcome.total
              << " cases; the same command goes on from here\n";
  }
  return result->good() ? kDone : kFailed;
}

}  // namespace

void add_experiment(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ExperimentOptions>();
  CLI::App* command = app.add_subcommand(
      "experiment", "runs fleets in the twin over a grid of settings and seeds, and reports what came of it");
  command->add_option("-c,--config", options->config, "EXPERIMENT.yaml")->required();
  command
      ->add_option("--out", options->out,
                   "folder for results.json, results.csv, tables.md and report.html; a start that was "
                   "interrupted goes on "
                   "where it was")
      ->required()
      ->check(some_path());
  command->add_flag("--quick", options->quick, "the file's quick set: fewer points and seeds");
  command->add_option("--jobs", options->jobs, "cases at a time, each a process of its own; else one a core")
      ->check(whole_number(1, 1024));
  command->add_option("--set", options->set, "key=value, a key of every fleet that the studies do not vary")
      ->allow_extra_args(false);
  command->add_flag("--keep", options->keep, "leave stores, maps and recordings of finished cases");
  command->add_flag("--any-build", options->any_build,
                    "take cases that another build of fleetmap has finished, too");
  command->add_flag("--list", options->list, "only print the cases and their keys");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace fleetmap::apps
