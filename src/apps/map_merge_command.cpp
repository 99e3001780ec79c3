// `fleetmap map merge`: stores of several days, or of several robots, become one.
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "map_subcommands.hpp"
#include "merge_summary.hpp"
#include "merged_store.hpp"
#include "options.hpp"

namespace fleetmap::apps {
namespace {

namespace fs = std::filesystem;

struct MergeOptions {
  std::vector<std::string> stores;
  std::string out;
  std::string keys;
};

int merge(const MergeOptions& options) {
  fs::path out = options.out;
  if (out.extension() != ".db") {
    if (const Status writable = make_writable(out); !writable) return report(writable.error(), kFailed);
    out /= "store.db";
  }
  std::optional<fs::path> keys;
  if (!options.keys.empty()) keys = options.keys;
  const std::vector<fs::path> files(options.stores.begin(), options.stores.end());
  const auto merged = merge_stores(files, out, keys);
  if (!merged) return report(merged.error(), kFailed);
  print_summary(std::cout, *merged, options.stores, out.string());
  return kDone;
}

}  // namespace

void add_map_merge(CLI::App& map, int& exit_code) {
  auto options = std::make_shared<MergeOptions>();
  CLI::App* command = map.add_subcommand("merge", "stores of several days or robots become one, aligned");
  command->add_option("stores", options->stores, "store.db of each day or robot")
      ->required()
      ->expected(2, 64);
  command->add_option("--out", options->out, "FILE.db, or a folder for store.db")
      ->required()
      ->check(some_path());
  command
      ->add_option("--keys", options->keys,
                   "folder of a member's keys; items count only if their makers signed them")
      ->check(some_path());
  command->callback([options, &exit_code] { exit_code = merge(*options); });
}

}  // namespace fleetmap::apps
