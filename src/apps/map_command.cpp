#include <array>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <memory>
#include <numbers>
#include <string>
#include <string_view>

#include "commands.hpp"
#include "fleetmap/graph/frame_name.hpp"
#include "fleetmap/output/map_files.hpp"
#include "fleetmap/output/map_parts.hpp"
#include "fleetmap/output/map_recipe.hpp"
#include "fleetmap/output/placed_store.hpp"
#include "fleetmap/store/thinned_map.hpp"
#include "map_pictures.hpp"
#include "options.hpp"
#include "store_summary.hpp"

namespace fleetmap::apps {
namespace {

struct MapOptions {
  std::string store;
  std::string out;
  std::optional<double> voxel;
  std::vector<double> origin_deg;
  bool json = false;
};

std::optional<GeoPoint> configured_origin(const MapOptions& options) {
  if (options.origin_deg.empty()) return std::nullopt;
  return geo_point_from_degrees(options.origin_deg[0], options.origin_deg[1], options.origin_deg[2]);
}

struct OpenedMap {
  store::Store store;
  output::MapRecipe recipe;
  graph::Placement placement;
};

/// A file that SQLite would call damaged, or a disk error, is most often another one than was meant.
Status check_store(const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error))
    return failure(file.string() + ": is a folder; give the store.db of a robot in it");
  if (!std::filesystem::exists(file, error)) return failure(file.string() + ": no such file");
  constexpr std::string_view kStart = "SQLite format 3";
  std::string start(kStart.size(), ' ');
  std::ifstream in(file, std::ios::binary);
  if (!in) return failure(file.string() + ": cannot be read; check its permissions");
  if (!in.read(start.data(), static_cast<std::streamsize>(start.size())) || start != kStart)
    return failure(file.string() + ": is no store; give the store.db of a robot");
  return {};
}

Result<OpenedMap> open_map(const MapOptions& options) {
  if (const Status meant = check_store(options.store); !meant) return tl::unexpected(meant.error());
  auto store = store::Store::open_read_only(options.store);
  if (!store) return tl::unexpected(store.error());
  const std::optional<output::MapRecipe> kept = output::map_recipe(*store);
  output::MapRecipe recipe = kept.value_or(output::MapRecipe{});
  std::optional<GeoPoint> origin = configured_origin(options);
  if (!origin && kept) origin = kept->origin;
  origin = output::site_origin(*store, origin);
  if (!origin || store->nodes().empty())
    return failure(options.store + ": holds no node, so there is no map");
  if (!is_valid(*origin))
    return failure("--origin is not on Earth; expected latitude_deg,longitude_deg,altitude_m");
  recipe.origin = *origin;
  if (options.voxel) recipe.merge.voxel_m = *options.voxel;
  auto placement = output::place(*store, *origin, recipe.placement);
  return OpenedMap{std::move(*store), recipe, std::move(placement)};
}

/// A summary that scripts compare: it needs no placement, so that an empty store has one, too.
int info_json(const MapOptions& options) {
  if (const Status meant = check_store(options.store); !meant) return report(meant.error(), kFailed);
  const auto store = store::Store::open_read_only(options.store);
  if (!store) return report(store.error(), kFailed);
  std::cout << summary_of(*store).dump(2) << '\n';
  return kDone;
}

int info(const MapOptions& options) {
  if (options.json) return info_json(options);
  const auto map = open_map(options);
  if (!map) return report(map.error(), kFailed);
  constexpr double kDegree = std::numbers::pi / 180.0;
  std::cout << "store of " << map->store.self().str() << '\n'
            << "nodes " << map->store.nodes().size() << ", submaps held " << map->store.submap_set().size()
            << ", alignments " << map->store.alignments().size() << " (" << map->placement.used.size()
            << " used)\n"
            << std::setprecision(10) << "origin " << map->recipe.origin.latitude / kDegree << ", "
            << map->recipe.origin.longitude / kDegree << " deg, " << map->recipe.origin.altitude << " m\n";
  for (const auto& component : map->placement.components) {
    std::cout << "aligned together:";
    for (const graph::FrameId& frame : component) std::cout << ' ' << graph::to_string(frame);
    std::cout << '\n';
  }
  return kDone;
}

/// Of the nodes that map.ply shows.
std::map<NodeId, Pose> shown_poses(const OpenedMap& map) {
  return output::map_parts(output::nodes_of(map.store), map.placement).main.T_map_node;
}

void name_unreadable(const store::MapOutline& outline) {
  for (const NodeId& id : outline.unreadable)
    std::cerr << "submap of " << to_string(id) << " cannot be read and is left out\n";
}

int export_map(const MapOptions& options) {
  auto map = open_map(options);
  if (!map) return report(map.error(), kFailed);
  if (const Status valid = map->recipe.merge.validate(); !valid) return report(valid.error(), kUsage);
  const std::array files{std::filesystem::path(options.out)};
  const auto written = output::write_merged(map->store, shown_poses(*map), map->recipe.merge, files);
  if (!written) return report(written.error(), kFailed);
  name_unreadable(written->outline);
  std::cout << options.out << ": " << written->points << " points from " << written->outline.submaps
            << " submaps\n";
  return kDone;
}

/// The pictures, in memory for a map that is thinned to what can be drawn: its tiles come once for their
/// points and once to be counted around these.
Result<std::vector<MapPicture>> pictures_of(OpenedMap& map) {
  constexpr double kDensityRadius = 1.0;  // m
  auto merge = output::tiled_map(map.store, shown_poses(map), map.recipe.merge);
  if (!merge) return tl::unexpected(merge.error());
  store::ThinnedMap thinned(map.recipe.merge.voxel_m, kMostDrawn);
  const auto thin = [&](const store::MapTile& tile) -> Status {
    thinned.add(tile);
    return {};
  };
  if (const Status done = merge->stream(thin); !done) return tl::unexpected(done.error());
  name_unreadable(merge->outline());
  const store::MergedMap shown = thinned.map(merge->outline());
  auto pictures = pictures_by_robot(shown);
  if (!pictures) return pictures;
  std::vector<std::uint32_t> counts(shown.cloud.size());
  const auto count = [&](const store::MapTile& tile) -> Status {
    add_density(shown.cloud, tile.cloud, kDensityRadius, counts);
    return {};
  };
  if (const Status done = merge->stream(count); !done) return tl::unexpected(done.error());
  auto density = picture_of_density(shown.cloud, counts, kDensityRadius);
  if (density) pictures->push_back(std::move(*density));
  return pictures;
}

int draw_map(const MapOptions& options) {
  auto map = open_map(options);
  if (!map) return report(map.error(), kFailed);
  if (const Status writable = make_writable(options.out); !writable) return report(writable.error(), kFailed);
  const auto pictures = pictures_of(*map);
  if (!pictures) return report({options.store + ": " + pictures.error().message}, kFailed);
  for (const MapPicture& picture : *pictures) {
    if (const Status written = write_picture(options.out, picture); !written)
      return report(written.error(), kFailed);
    std::cout << (std::filesystem::path(options.out) / picture.file).string() << '\n';
  }
  return kDone;
}

}  // namespace

void add_map(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<MapOptions>();
  CLI::App* command = app.add_subcommand("map", "looks into a store, or writes its map");
  command->require_subcommand(1);
  CLI::App* info_command = command->add_subcommand("info", "what a store holds");
  CLI::App* export_command = command->add_subcommand("export", "the merged map in ENU as PLY or PCD");
  CLI::App* picture_command = command->add_subcommand(
      "picture", "the merged map from above and in perspective, by robot and density");
  for (CLI::App* sub : {info_command, export_command, picture_command}) {
    sub->add_option("store", options->store, "store.db of an agent")->required();
    sub->add_option("--origin", options->origin_deg,
                    "latitude_deg,longitude_deg,altitude_m of ENU; else that of the agent's last map, or the "
                    "least node's")
        ->delimiter(',')
        ->expected(3);
  }
  info_command->add_flag("--json", options->json,
                         "nodes, alignments and submaps held, by robot, and the hash of the set");
  export_command->add_option("--out", options->out, "FILE.ply or FILE.pcd")->required()->check(some_path());
  export_command->add_option(
      "--voxel", options->voxel,
      "m, one point is kept in each cube of this edge; else as in the agent's last map");
  picture_command->add_option("--out", options->out, "folder for the PNG files")
      ->required()
      ->check(some_path());
  picture_command->callback([options, &exit_code] { exit_code = draw_map(*options); });
  info_command->callback([options, &exit_code] { exit_code = info(*options); });
  export_command->callback([options, &exit_code] { exit_code = export_map(*options); });
}

}  // namespace fleetmap::apps
