#include "day_comparison.hpp"

#include <string>

#include "day_changes.hpp"
#include "fleetmap/change/change_files.hpp"
#include "fleetmap/core/whole_file.hpp"

namespace fleetmap::apps {

CommandResult<ExitCode> compare_days(const DiffOptions& options, std::ostream& out) {
  const auto compared = changes_between(options.before, options.after);
  if (!compared) return exit_with(kFailed, compared.error());
  print_changes(out, *compared);
  if (!options.ply.empty()) {
    if (const Status written = change::write_coloured(options.ply, compared->changes); !written)
      return exit_with(kFailed, written.error());
  }
  if (options.geojson.empty()) return kDone;
  if (!compared->origin) {
    return exit_with(
        kFailed, {options.geojson + ": neither day has GPS, so nobody knows where on Earth the changes are"});
  }
  const Status written =
      write_whole_file(options.geojson, change::to_geojson(compared->changes, *compared->origin));
  return written ? CommandResult<ExitCode>(kDone) : exit_with(kFailed, written.error());
}

}  // namespace fleetmap::apps
