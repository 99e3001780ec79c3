// `fleetmap map merge`: stores of several days, or of several robots, become one.
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "map_subcommands.hpp"
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

constexpr std::size_t kMaxNamed = 20;

void print_union(const std::string& file, const exchange::StoreUnion& added) {
  std::cout << file << ": " << added.nodes << " nodes, " << added.submaps << " submaps, " << added.alignments
            << " alignments added, " << added.known << " items known\n";
  if (added.unproven > 0)
    std::cout << file << ": " << added.unproven << " items left out: their makers did not sign them\n";
  if (added.unreadable > 0)
    std::cout << file << ": " << added.unreadable << " submaps are damaged and left out\n";
  for (std::size_t k = 0; k < std::min(kMaxNamed, added.contested.size()); ++k)
    std::cout << file << ": " << added.contested[k] << " has two contents; neither is used\n";
  if (added.contested.size() > kMaxNamed)
    std::cout << file << ": and " << added.contested.size() - kMaxNamed << " more names\n";
  if (!added.contested.empty())
    std::cout << file
              << ": two `fleetmap run` of one robot number their sessions alike; repeat one of them "
                 "with --first-session 1000\n";
}

void print_pair(const DayPair& pair, const std::vector<std::string>& files) {
  const std::string &earlier = files[pair.earlier], &later = files[pair.later];
  std::size_t rejected = 0;
  for (const auto& [reason, count] : pair.alignments.rejected) rejected += count;
  if (pair.joined) {
    std::cout << earlier << " and " << later << ": joined by " << pair.used << " alignments"
              << (pair.frames_shared ? " and the sessions that both have" : "");
  } else {
    std::cout << earlier << " and " << later << ": NOT joined: " << pair.why_not;
  }
  std::cout << " (" << pair.alignments.candidates << " candidates: " << pair.alignments.accepted
            << " accepted, " << pair.alignments.ambiguous << " ambiguous, " << rejected << " rejected)\n";
  for (const auto& [reason, count] : pair.alignments.rejected)
    std::cout << "  rejected " << count << " times: " << reason << '\n';
}

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
  for (std::size_t k = 0; k < files.size(); ++k) print_union(options.stores[k], merged->unions[k]);
  for (const DayPair& pair : merged->pairs) print_pair(pair, options.stores);
  std::cout << out.string() << ": " << merged->placement.T_enu_node.size() << " nodes, "
            << merged->placement.used.size() << " alignments used, " << merged->placement.components.size()
            << " parts that no alignment joins\n";
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
