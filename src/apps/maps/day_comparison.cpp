#include "day_comparison.hpp"

#include <string>
#include <vector>

#include "day_changes.hpp"
#include "fleetmap/change/change_files.hpp"
#include "fleetmap/core/whole_file.hpp"
#include "fleetmap/output/map_crs.hpp"

namespace fleetmap::apps {
namespace {

/// Says what the coordinates of a file in the map's own frame are, as maps' files do.
std::vector<std::string> frame_comments(const DayChanges& compared) {
  const std::optional<GeoPoint>& origin = compared.origin;
  const output::MapPlace place{origin.value_or(GeoPoint{}), origin.has_value(), compared.above_sea_level};
  const auto crs = output::MapCrs::of({output::CrsRequest::Kind::enu, {}}, place, std::nullopt);
  if (!crs) return {};
  return {crs->text(), "CRS: " + crs->wkt()};
}

}  // namespace

CommandResult<ExitCode> compare_days(const DiffOptions& options, std::ostream& out) {
  const auto compared = changes_between(options.before, options.after);
  if (!compared) return exit_with(kFailed, compared.error());
  print_changes(out, *compared);
  if (!options.ply.empty()) {
    const Status written = change::write_coloured(options.ply, compared->changes, frame_comments(*compared));
    if (!written) return exit_with(kFailed, written.error());
  }
  if (options.geojson.empty()) return kDone;
  if (!compared->origin) {
    return exit_with(
        kFailed, {options.geojson + ": neither day has GPS, so nobody knows where on Earth the changes are"});
  }
  const Status written = write_whole_file(
      options.geojson, change::to_geojson(compared->changes, *compared->origin, compared->above_sea_level));
  return written ? CommandResult<ExitCode>(kDone) : exit_with(kFailed, written.error());
}

}  // namespace fleetmap::apps
