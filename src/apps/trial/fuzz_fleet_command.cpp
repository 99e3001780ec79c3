#include <iostream>
#include <memory>

#include "commands.hpp"
#include "fault_search.hpp"
#include "validators.hpp"

namespace fleetmap::apps {

void add_fuzz_fleet(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<FuzzOptions>();
  CLI::App* command = app.add_subcommand(
      "fuzz-fleet",
      "simulates fleets with random faults in virtual time; finds, replays and shrinks failing sequences");
  command->add_option("--seeds", options->seeds, "fleets to simulate")->check(whole_number(1));
  command->add_option("--from", options->from, "the first seed")->check(whole_number(0));
  command->add_option("--replay", options->replay, "simulates this seed alone and prints its events")
      ->check(whole_number(0));
  command
      ->add_option("--keep", options->keep, "with --replay: numbers of the faults that are applied, e.g. 0,3")
      ->delimiter(',');
  command
      ->add_option("--stores", options->stores,
                   "with --replay: folder for the robots' stores as they end, for `map` and `monitor`")
      ->check(some_path());
  command->add_option("--robots", options->robots, "number of robots; two numbers are a range (3,10)")
      ->delimiter(',')
      ->check(whole_number(2, 20));
  command->add_option("--faults", options->faults, "kinds of faults, separated by commas, or all");
  command->add_option("--invariants", options->invariants,
                      "invariants that are checked, separated by commas, or all");
  command
      ->add_option("--mapping", options->mapping,
                   "s, duration of the mapping, during which faults are applied")
      ->check(positive_number());
  command->add_option("--jobs", options->jobs, "fleets at a time")
      ->check(whole_number(1, 256))
      ->default_str("one for each core");
  command->add_flag("--signatures", options->signatures,
                    "robots sign their items, as a fleet with keys does");
  command->add_flag("--no-shrink", options->no_shrink,
                    "does not search for the smallest set of faults that fails");
  command->callback([options, &exit_code] { exit_code = report(search_faults(*options, std::cout)); });
}

}  // namespace fleetmap::apps
