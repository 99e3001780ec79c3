#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "fleetmap/core/text_list.hpp"
#include "fleetmap/output/map_crs.hpp"
#include "las_export.hpp"
#include "map_exports.hpp"
#include "map_info.hpp"
#include "map_subcommands.hpp"
#include "options.hpp"
#include "store_summary.hpp"
#include "stored_map.hpp"

namespace fleetmap::apps {
namespace {

struct MapOptions {
  std::string store;
  std::string out;
  std::optional<double> voxel;
  std::vector<double> origin_deg;
  std::vector<std::string> without;
  bool json = false;
  LasOptions las;
};

Result<StoredMap> open(const MapOptions& options) {
  MapChoice choice;
  if (const auto& deg = options.origin_deg; !deg.empty())
    choice.origin = geo_point_from_degrees(deg[0], deg[1], deg[2]);
  choice.voxel_m = options.voxel;
  auto without = robots_named(options.without);
  if (!without) return tl::unexpected(without.error());
  choice.without = std::move(*without);
  return open_map(options.store, choice);
}

/// A summary that scripts compare: it needs no placement, so that an empty store has one, too.
int info_json(const MapOptions& options) {
  if (!options.without.empty()) return report({"--json lists by robot, so it takes no --without"}, kUsage);
  if (const Status meant = check_store(options.store); !meant) return report(meant.error(), kFailed);
  const auto store = store::Store::open_read_only(options.store);
  if (!store) return report(store.error(), kFailed);
  std::cout << summary_of(*store).dump(2) << '\n';
  return kDone;
}

int info(const MapOptions& options) {
  if (options.json) return info_json(options);
  const auto map = open(options);
  if (!map) return report(map.error(), kFailed);
  print_info(std::cout, *map);
  return kDone;
}

int print(const Result<std::string>& written) {
  if (!written) return report(written.error(), kFailed);
  std::cout << *written << '\n';
  return kDone;
}

int export_map(const MapOptions& options) {
  const bool las = wants_las(options.out, options.las);
  if (options.las.any() && !las)
    return report({options.out + ": --crs and --geoid are of LAS; end it with .las"}, kUsage);
  auto map = open(options);
  if (!map) return report(map.error(), kFailed);
  if (const Status valid = map->recipe.merge.validate(); !valid) return report(valid.error(), kUsage);
  if (!las) return print(export_points(*map, options.out));
  const Status written = export_las(*map, options.store, options.out, options.las);
  return written ? kDone : report(written.error(), kFailed);
}

int write_tracks(const MapOptions& options) {
  const auto map = open(options);
  return map ? print(export_tracks(*map, options.store, options.out)) : report(map.error(), kFailed);
}

int write_graph(const MapOptions& options) {
  const auto map = open(options);
  return map ? print(export_graph(*map, options.out)) : report(map.error(), kFailed);
}

int draw_map(const MapOptions& options) {
  auto map = open(options);
  if (!map) return report(map.error(), kFailed);
  const auto files = export_pictures(*map, options.store, options.out);
  if (!files) return report(files.error(), kFailed);
  for (const std::filesystem::path& file : *files) std::cout << file.string() << '\n';
  return kDone;
}

CLI::Validator ends_with(std::vector<std::string> extensions) {
  const auto check = [extensions = std::move(extensions)](const std::string& file) -> std::string {
    const std::string extension = std::filesystem::path(file).extension();
    if (std::ranges::find(extensions, extension) != extensions.end()) return {};
    std::string expected;
    for (const std::string& one : extensions) append_to_list(expected, one, " or ");
    return file + ": must end with " + expected;
  };
  return {check, "FILE"};
}

CLI::Validator reference_system() {
  const auto check = [](const std::string& text) {
    const auto choice = output::parse_crs(text);
    return choice ? std::string() : choice.error().message;
  };
  return {check, "CRS"};
}

void add_export_options(CLI::App& command, MapOptions& options) {
  command.add_option("--out", options.out, "FILE.las, FILE.ply or FILE.pcd; with --tile a folder")
      ->required()
      ->check(some_path());
  command.add_option("--voxel", options.voxel,
                     "m, one point is kept in each cube of this edge; else as in the agent's last map");
  command
      .add_option("--crs", options.las.crs,
                  "coordinates of LAS: utm (the origin's zone, the default), EPSG:326xx or 327xx, or enu")
      ->check(reference_system());
  command.add_option(
      "--geoid", options.las.geoid,
      "heights of LAS above this geoid of GeographicLib (egm2008-5); else above the ellipsoid");
  command.add_option("--tile", options.las.tile_m, "m, LAS files of squares of this edge, in a folder")
      ->check(whole_number(1, 1'000'000));
}

}  // namespace

void add_map(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<MapOptions>();
  CLI::App* command = app.add_subcommand("map", "looks into a store, or writes its map");
  command->require_subcommand(1);
  CLI::App* info_command = command->add_subcommand("info", "what a store holds");
  CLI::App* export_command =
      command->add_subcommand("export", "the merged map as LAS, or in ENU as PLY or PCD");
  CLI::App* picture_command = command->add_subcommand(
      "picture", "the merged map from above and in perspective, by robot and density");
  CLI::App* tracks_command = command->add_subcommand("tracks", "the ways of all robots as placed, in WGS84");
  CLI::App* graph_command =
      command->add_subcommand("graph", "nodes, odometry and alignments in use, for g2o");
  for (CLI::App* sub : {info_command, export_command, picture_command, tracks_command, graph_command}) {
    sub->add_option("store", options->store, "store.db of an agent")->required();
    sub->add_option("--origin", options->origin_deg,
                    "latitude_deg,longitude_deg,altitude_m of ENU; else that of the agent's last map, or the "
                    "least node's")
        ->delimiter(',')
        ->expected(3);
    sub->add_option("--without", options->without,
                    "robots, comma-separated, whose nodes and alignments are left out: the map is placed and "
                    "made of the rest")
        ->delimiter(',')
        ->allow_extra_args(false);
  }
  info_command->add_flag("--json", options->json,
                         "nodes, alignments and submaps held, by robot, and the hash of the set");
  add_export_options(*export_command, *options);
  picture_command->add_option("--out", options->out, "folder for the PNG files")
      ->required()
      ->check(some_path());
  picture_command->callback([options, &exit_code] { exit_code = draw_map(*options); });
  info_command->callback([options, &exit_code] { exit_code = info(*options); });
  export_command->callback([options, &exit_code] { exit_code = export_map(*options); });
  tracks_command->add_option("--out", options->out, "FILE.gpx or FILE.geojson")
      ->required()
      ->check(ends_with({".gpx", ".geojson"}));
  tracks_command->callback([options, &exit_code] { exit_code = write_tracks(*options); });
  graph_command->add_option("--out", options->out, "FILE.g2o")->required()->check(ends_with({".g2o"}));
  graph_command->callback([options, &exit_code] { exit_code = write_graph(*options); });
  add_map_merge(*command, exit_code);
  add_map_diff(*command, exit_code);
}

}  // namespace fleetmap::apps
