#include "las_export.hpp"

#include <filesystem>
#include <iomanip>
#include <iostream>
#include <utility>

#include "fleetmap/core/lower_case.hpp"
#include "fleetmap/output/las_map.hpp"
#include "fleetmap/output/sea_level_heights.hpp"
#include "parts_apart.hpp"
#include "version.hpp"

namespace fleetmap::apps {
namespace {

void print_las(std::ostream& out, const output::WrittenLas& written, const std::string& path,
               const output::MapCrs& crs, const LasOptions& options) {
  out << path << ": ";
  if (options.tile_m) out << written.files << " files of " << *options.tile_m << " m, ";
  out << written.points << " points from " << written.outline.submaps << " submaps\n" << crs.text() << '\n';
  if (crs.name() != "enu") {
    out << "Scale at the origin: " << std::fixed << std::setprecision(6) << crs.scale()
        << " (lengths in it over lengths on the ellipsoid).\n";
  }
  if (written.left_out > 0)
    std::cerr << written.left_out << " points are not finite or too far away and are left out\n";
  name_unreadable(written.outline);
}

}  // namespace

Result<output::MapCrs> crs_of(const LasOptions& options, const StoredMap& map, const output::MapPart& part,
                              const std::string& store) {
  const auto request = output::parse_crs(options.crs.value_or("utm"));
  if (!request) return tl::unexpected(request.error());
  std::optional<Geoid> geoid;
  if (options.geoid) {
    auto loaded = Geoid::load(*options.geoid);
    if (!loaded) return tl::unexpected(loaded.error());
    geoid = std::move(*loaded);
  }
  const output::MapPlace place{map.recipe.origin, part.georeferenced,
                               output::has_sea_level_heights(map.store), output::unknown_heights(map.store)};
  auto crs = output::MapCrs::of(*request, place, std::move(geoid));
  if (!crs) return failure(store + ": " + crs.error().message);
  return crs;
}

bool wants_las(const std::string& path, const LasOptions& options) {
  return options.tile_m || lower_case(std::filesystem::path(path).extension().string()) == ".las";
}

Status export_las(StoredMap& map, const std::string& store, const std::string& path,
                  const LasOptions& options, std::ostream& out) {
  const output::MapParts parts = output::map_parts(map.items.nodes, map.placement);
  const auto crs = crs_of(options, map, parts.main, store);
  if (!crs) return tl::unexpected(crs.error());
  const output::LasMapConfig config{path, options.tile_m, std::string("fleetmap ") + kVersion};
  const auto written = output::write_las(map.store, parts.main.T_map_node, map.recipe.merge, *crs, config);
  if (!written) return tl::unexpected(written.error());
  print_las(out, *written, path, *crs, options);
  name_holes(map);
  name_parts_apart(parts, std::cerr);
  return {};
}

}  // namespace fleetmap::apps
