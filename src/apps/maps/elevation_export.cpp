#include "elevation_export.hpp"

#include <iostream>

#include "fleetmap/output/elevation_map.hpp"
#include "las_export.hpp"
#include "options.hpp"
#include "parts_apart.hpp"
#include "version.hpp"

namespace fleetmap::apps {

Status export_elevation(StoredMap& map, const MapOptions& options, std::ostream& out) {
  const output::MapParts parts = output::map_parts(map.items.nodes, map.placement);
  const auto crs = crs_of(options.las, map, parts.main, options.store);
  if (!crs) return tl::unexpected(crs.error());
  output::ElevationConfig config;
  if (options.cell_m) config.cell_m = *options.cell_m;
  const auto written =
      output::write_elevation(map.store, parts.main.T_map_node, map.recipe.merge, *crs, config, options.out,
                              std::string("fleetmap ") + kVersion, stop_on_signals());
  if (!written) return tl::unexpected(written.error());
  out << options.out << ": ground.tif, surface.tif, hillshade.tif of " << written->width << " x "
      << written->height << " cells of " << config.cell_m << " m; points in " << written->observed
      << ", ground seen in " << written->ground << " of them\n"
      << crs->text() << '\n';
  name_holes(map);
  name_unreadable(written->outline);
  name_parts_apart(parts, std::cerr);
  return {};
}

}  // namespace fleetmap::apps
