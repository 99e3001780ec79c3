#include "store_merge.hpp"

#include <filesystem>
#include <optional>
#include <vector>

#include "merge_summary.hpp"
#include "merged_store.hpp"
#include "options.hpp"
#include "page/preview_files.hpp"

namespace fleetmap::apps {

namespace fs = std::filesystem;

CommandResult<ExitCode> merge_files(const MergeOptions& options, std::ostream& out) {
  fs::path file = options.out;
  if (file.extension() != ".db") {
    if (const Status writable = make_writable(file); !writable) return exit_with(kFailed, writable.error());
    file /= "store.db";
  }
  std::optional<fs::path> keys;
  if (!options.keys.empty()) keys = options.keys;
  const std::vector<fs::path> stores(options.stores.begin(), options.stores.end());
  const auto merged = merge_stores(stores, file, keys);
  if (!merged) return exit_with(kFailed, merged.error());
  keep_previews(file, stores);
  print_summary(out, *merged, options.stores, file.string());
  return kDone;
}

}  // namespace fleetmap::apps
