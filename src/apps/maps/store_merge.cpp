#include "store_merge.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "merge_summary.hpp"
#include "merged_store.hpp"
#include "options.hpp"
#include "page/preview_files.hpp"

namespace fleetmap::apps {

namespace fs = std::filesystem;

namespace {

std::optional<std::string> named_twice(const std::vector<fs::path>& stores) {
  for (std::size_t k = 1; k < stores.size(); ++k) {
    for (std::size_t other = 0; other < k; ++other) {
      std::error_code missing;
      if (fs::equivalent(stores[k], stores[other], missing)) return stores[k].string();
    }
  }
  return std::nullopt;
}

}  // namespace

CommandResult<ExitCode> merge_files(const MergeOptions& options, std::ostream& out) {
  fs::path file = options.out;
  if (file.extension() != ".db") {
    if (const Status writable = make_writable(file); !writable) return exit_with(kFailed, writable.error());
    file /= "store.db";
  }
  std::optional<fs::path> keys;
  if (!options.keys.empty()) keys = options.keys;
  const std::vector<fs::path> stores(options.stores.begin(), options.stores.end());
  if (const auto twice = named_twice(stores))
    return exit_with(kUsage, {*twice + ": this store is named twice"});
  const auto merged = merge_stores(stores, file, keys);
  if (!merged) return exit_with(kFailed, merged.error());
  keep_previews(file, stores);
  print_summary(out, *merged, options.stores, file.string(), options.verbose);
  return kDone;
}

}  // namespace fleetmap::apps
