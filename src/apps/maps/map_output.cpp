#include "map_output.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <string>
#include <utility>

#include "elevation_export.hpp"
#include "fleetmap/core/lower_case.hpp"
#include "fleetmap/core/paths.hpp"
#include "fleetmap/output/map_parts.hpp"
#include "las_export.hpp"
#include "map_exports.hpp"
#include "map_info.hpp"
#include "parts_apart.hpp"
#include "store_summary.hpp"
#include "stored_map.hpp"

namespace fleetmap::apps {
namespace {

CommandResult<StoredMap> open(const MapOptions& options) {
  MapSelection selection;
  if (const auto& deg = options.origin_deg; !deg.empty()) {
    selection.origin = geo_point_from_degrees(deg[0], deg[1], deg[2]);
    if (!is_valid(*selection.origin))
      return exit_with(kUsage, {"--origin is not on Earth; expected latitude_deg,longitude_deg,altitude_m"});
  }
  selection.voxel_m = options.voxel;
  auto without = robots_named(options.without);
  if (!without) return exit_with(kUsage, {"--without: " + without.error().message});
  selection.without = std::move(*without);
  auto map = open_map(options.store, selection);
  if (!map) return exit_with(kFailed, map.error());
  if (selection.origin && !map->items.nodes.empty() && map->placement.T_enu_node.empty())
    return exit_with(kFailed, {options.store + ": none of its " + std::to_string(map->items.nodes.size()) +
                               " nodes lies near this origin; give one at the site, or leave --origin out"});
  return std::move(*map);
}

bool is_point_file(const std::string& file) {
  const std::string extension = lower_case(std::filesystem::path(file).extension().string());
  return extension == ".ply" || extension == ".pcd";
}

/// True if the name of a folder that is to be made ends as that of a picture.
bool is_named_as_file(const std::string& folder) {
  constexpr std::array kEndings{".tif", ".tiff", ".png", ".jpg", ".jpeg", ".svg", ".pdf"};
  const std::string extension = lower_case(std::filesystem::path(folder).extension().string());
  return !is_folder(folder) && std::ranges::find(kEndings, extension) != kEndings.end();
}

CommandResult<ExitCode> print_json(const MapOptions& options, std::ostream& out) {
  if (!options.without.empty()) return exit_with(kUsage, {"--json lists by robot, so it takes no --without"});
  if (const Status meant = check_store(options.store); !meant) return exit_with(kFailed, meant.error());
  const auto store = store::Store::open_read_only(options.store);
  if (!store) return exit_with(kFailed, store.error());
  out << summary_of(*store).dump(2) << '\n';
  return kDone;
}

CommandResult<ExitCode> print_written(const Result<std::string>& written, std::ostream& out) {
  if (!written) return exit_with(kFailed, written.error());
  out << *written << '\n';
  return kDone;
}

}  // namespace

CommandResult<ExitCode> print_map_info(const MapOptions& options, std::ostream& out) {
  if (options.json) return print_json(options, out);
  const auto map = open(options);
  if (!map) return tl::unexpected(map.error());
  print_info(out, *map);
  return kDone;
}

CommandResult<ExitCode> write_map(const MapOptions& options, std::ostream& out) {
  const bool rasters = options.format == "geotiff";
  const bool las = !rasters && wants_las(options.out, options.las);
  const bool points = is_point_file(options.out);
  if (las && points && options.las.tile_m)
    return exit_with(kUsage, {"--tile is of LAS: name a folder for the tiles in place of " + options.out});
  if (!las && !rasters && !points)
    return exit_with(kUsage, {options.out +
                              ": end it with .ply, .pcd or .las, or add --format geotiff and name a folder"});
  if (rasters && is_named_as_file(options.out))
    return exit_with(kUsage, {options.out + ": GeoTIFFs are three files; name a folder for them"});
  if (rasters && options.las.tile_m) return exit_with(kUsage, {"--tile is of LAS; a GeoTIFF is one raster"});
  if (options.cell_m && !rasters) return exit_with(kUsage, {"--cell is of rasters: add --format geotiff"});
  if (options.las.any() && !las && !rasters)
    return exit_with(
        kUsage, {options.out +
                 ": --crs and --geoid are of LAS and GeoTIFF: end it with .las, or add --format geotiff"});
  auto map = open(options);
  if (!map) return tl::unexpected(map.error());
  if (const Status valid = map->recipe.merge.validate(); !valid) return exit_with(kUsage, valid.error());
  if (!las && !rasters) return print_written(export_points(*map, options.store, options.out), out);
  const Status written = rasters ? export_elevation(*map, options, out)
                                 : export_las(*map, options.store, options.out, options.las, out);
  return written ? CommandResult<ExitCode>(kDone) : exit_with(kFailed, written.error());
}

CommandResult<ExitCode> write_tracks(const MapOptions& options, std::ostream& out) {
  const std::optional<std::string>& geoid = options.las.geoid;
  if (geoid && !options.out.ends_with(".gpx"))
    return exit_with(kUsage, {"--geoid is of GPX; heights of GeoJSON are above the ellipsoid (RFC 7946)"});
  const auto map = open(options);
  if (!map) return tl::unexpected(map.error());
  return print_written(export_tracks(*map, options.store, options.out, geoid), out);
}

CommandResult<ExitCode> write_graph(const MapOptions& options, std::ostream& out) {
  const auto map = open(options);
  return map ? print_written(export_graph(*map, options.out), out) : tl::unexpected(map.error());
}

CommandResult<ExitCode> draw_map(const MapOptions& options, std::ostream& out) {
  if (is_named_as_file(options.out))
    return exit_with(kUsage, {options.out + ": there are several pictures; name a folder for them"});
  auto map = open(options);
  if (!map) return tl::unexpected(map.error());
  name_holes(*map);
  name_parts_apart(output::map_parts(map->items.nodes, map->placement), std::cerr);
  const auto files = export_pictures(*map, options.store, options.out);
  if (!files) return exit_with(kFailed, files.error());
  for (const std::filesystem::path& file : *files) out << file.string() << '\n';
  return kDone;
}

}  // namespace fleetmap::apps
