#include "grid_options.hpp"

#include <CLI/CLI.hpp>

#include "validators.hpp"

namespace fleetmap::apps {

void add_grid_options(CLI::App& command, GridOptions& options) {
  command
      .add_option("--out", options.out,
                  "folder for results.json, results.csv, tables.md and report.html; an interrupted "
                  "start is continued")
      ->required()
      ->check(some_path());
  command.add_flag("--quick", options.quick, "the file's quick set: fewer points and seeds");
  command.add_option("--set", options.set, "key=value, a key of every fleet that the studies do not vary")
      ->allow_extra_args(false);
  command.add_flag("--keep", options.keep, "keeps stores, maps and recordings of finished cases");
  command.add_flag("--any-build", options.any_build,
                   "uses cases that another build of fleetmap has finished, too");
  command.add_flag("--list", options.list, "prints the cases and their keys, and runs none");
  command
      .add_option(
          "--case", options.one_case,
          "runs only this case, by its name in --list; several processes may do so in one DIR at a time")
      ->check(CLI::Validator(
          [](const std::string& name) {
            return name.empty() ? std::string("is empty; give a name of --list (is a variable unset?)")
                                : std::string();
          },
          "", "name"))
      ->excludes("--list");
  command
      .add_flag("--report", options.report,
                "runs nothing: reports the finished cases and lists the missing ones")
      ->excludes("--list")
      ->excludes("--case");
}

}  // namespace fleetmap::apps
