// `fleetmap map merge`: stores of several days, or of several robots, become one.
#include <iostream>
#include <memory>

#include "map_subcommands.hpp"
#include "store_merge.hpp"
#include "validators.hpp"

namespace fleetmap::apps {

void add_map_merge(CLI::App& map, int& exit_code) {
  auto options = std::make_shared<MergeOptions>();
  CLI::App* command =
      map.add_subcommand("merge", "aligns the stores of several days or robots and merges them into one");
  command->add_option("stores", options->stores, "store.db of each day or robot, at least two")
      ->required()
      ->expected(2, -1);
  command->add_option("--out", options->out, "FILE.db, or a folder for store.db")
      ->required()
      ->check(some_path());
  command
      ->add_option("--keys", options->keys,
                   "folder of a member's keys; items count only if their makers signed them")
      ->check(some_path());
  command->add_flag("--verbose", options->verbose,
                    "print each reason of a rejection with its numbers, and not only their range");
  command->callback([options, &exit_code] { exit_code = report(merge_files(*options, std::cout)); });
}

}  // namespace fleetmap::apps
