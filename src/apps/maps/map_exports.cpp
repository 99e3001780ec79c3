#include "map_exports.hpp"

#include <array>
#include <iostream>
#include <optional>
#include <utility>

#include "fleetmap/core/whole_file.hpp"
#include "fleetmap/output/graph_file.hpp"
#include "fleetmap/output/map_comments.hpp"
#include "fleetmap/output/map_files.hpp"
#include "fleetmap/output/map_parts.hpp"
#include "fleetmap/output/sea_level_heights.hpp"
#include "fleetmap/output/track_files.hpp"
#include "fleetmap/run_evaluation/map_pictures.hpp"
#include "options.hpp"
#include "parts_apart.hpp"

namespace fleetmap::apps {

Result<std::string> export_points(StoredMap& map, const std::string& store,
                                  const std::filesystem::path& out) {
  const std::array files{out};
  const output::MapParts parts = output::map_parts(map.items.nodes, map.placement);
  const output::MapPart& main = parts.main;
  auto merge = output::tiled_map(map.store, main.T_map_node, map.recipe.merge);
  if (!merge) return tl::unexpected(merge.error());
  if (const Status some = output::require_points(merge->outline()); !some)
    return failure(store + ": " + some.error().message);
  const auto written = output::write_planned(
      *merge, files, output::map_comments(map.store, main, map.recipe.origin, map.recipe.merge));
  if (!written) return tl::unexpected(written.error());
  name_holes(map);
  name_unreadable(written->outline);
  name_parts_apart(parts, std::cerr);
  return out.string() + ": " + std::to_string(written->points) + " points from " +
         std::to_string(written->outline.submaps) + " submaps";
}

Result<std::string> export_tracks(const StoredMap& map, const std::string& store,
                                  const std::filesystem::path& out,
                                  const std::optional<std::string>& geoid_name) {
  const std::vector<graph::Node>& nodes = map.items.nodes;
  const output::MapParts parts = output::map_parts(nodes, map.placement);
  const output::MapPart& main = parts.main;
  if (!main.georeferenced)
    return failure(store +
                   ": no node of its map has GPS, so that nobody knows where on Earth its tracks are");
  const bool above_sea = output::has_sea_level_heights(map.store);
  std::optional<Geoid> geoid;
  if (geoid_name) {
    auto loaded = Geoid::load(*geoid_name);
    if (!loaded) return tl::unexpected(loaded.error());
    geoid = std::move(*loaded);
  }
  const Result<std::string> text =
      out.extension() == ".gpx"
          ? output::to_gpx(nodes, main.T_map_node, map.recipe.origin, geoid, above_sea)
          : Result<std::string>(output::to_geojson(nodes, main.T_map_node, map.recipe.origin, above_sea));
  if (!text) return failure(store + ": " + text.error().message);
  if (const Status written = write_whole_file(out, *text); !written) return tl::unexpected(written.error());
  name_parts_apart(parts, std::cerr);
  return out.string() + ": " + std::to_string(main.T_map_node.size()) + " nodes";
}

Result<std::string> export_graph(const StoredMap& map, const std::filesystem::path& out) {
  const output::GraphText text = output::to_g2o(map.items.nodes, map.placement);
  const std::string names = out.string() + ".csv";
  if (const Status written = write_whole_file(out, text.graph); !written)
    return tl::unexpected(written.error());
  if (const Status written = write_whole_file(names, text.names); !written)
    return tl::unexpected(written.error());
  return out.string() + ", names of its " + std::to_string(map.placement.T_enu_node.size()) +
         " vertices: " + names;
}

Result<std::vector<std::filesystem::path>> export_pictures(StoredMap& map, const std::string& store,
                                                           const std::filesystem::path& out) {
  if (const Status writable = make_writable(out); !writable) return tl::unexpected(writable.error());
  const auto pictures = pictures_of(map);
  if (!pictures) return failure(store + ": " + pictures.error().message);
  std::vector<std::filesystem::path> files;
  for (const run_evaluation::MapPicture& picture : *pictures) {
    if (const Status written = run_evaluation::write_picture(out, picture); !written)
      return tl::unexpected(written.error());
    files.push_back(out / picture.file);
  }
  return files;
}

}  // namespace fleetmap::apps
