#include <iostream>
#include <memory>

#include "commands.hpp"
#include "map_output.hpp"
#include "map_subcommands.hpp"
#include "validators.hpp"

namespace fleetmap::apps {
namespace {

using Action = CommandResult<ExitCode> (*)(const MapOptions& options, std::ostream& out);

CLI::App* add_action(CLI::App& map, const char* name, const char* about,
                     const std::shared_ptr<MapOptions>& options, Action action, int& exit_code) {
  CLI::App* command = map.add_subcommand(name, about);
  command->add_option("store", options->store, "store.db of an agent")->required();
  command
      ->add_option("--origin", options->origin_deg,
                   "latitude_deg,longitude_deg,altitude_m of ENU; else that of the agent's last map, or the "
                   "least node's")
      ->delimiter(',')
      ->expected(3);
  command
      ->add_option("--without", options->without,
                   "robots, comma-separated, whose nodes and alignments are left out: the map is placed and "
                   "made of the rest")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->callback([options, action, &exit_code] { exit_code = report(action(*options, std::cout)); });
  return command;
}

void add_export_options(CLI::App& command, MapOptions& options) {
  command
      .add_option("--out", options.out,
                  "FILE.las, FILE.ply or FILE.pcd; a folder with --tile and with --format geotiff")
      ->required()
      ->check(some_path());
  command
      .add_option("--voxel", options.voxel,
                  "m, one point is kept in each cube of this edge; else as in the agent's last map")
      ->check(number_within(0.001, 1000.0));
  command
      .add_option(
          "--crs", options.las.crs,
          "coordinates of LAS and GeoTIFF: utm (the origin's zone, the default), EPSG:326xx or 327xx, or enu")
      ->check(reference_system());
  command.add_option(
      "--geoid", options.las.geoid,
      "heights of LAS and GeoTIFF above this geoid of GeographicLib (egm2008-5); else above the ellipsoid");
  command.add_option("--tile", options.las.tile_m, "m, LAS files of squares of this edge, in a folder")
      ->check(whole_number(1, 1'000'000));
  command
      .add_option(
          "--format", options.format,
          "geotiff: heights of the ground and of the surface, and a hillshade; else by the name of --out")
      ->check(CLI::IsMember({"geotiff"}));
  command.add_option("--cell", options.cell_m, "m, edge of a raster's cell; 0.5 by default")
      ->check(number_within(0.05, 1000.0));
}

}  // namespace

void add_map(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<MapOptions>();
  CLI::App* command = app.add_subcommand("map", "prints the contents of a store, or writes its map");
  command->require_subcommand(1);
  const auto add = [&](const char* name, const char* about, Action action) {
    return add_action(*command, name, about, options, action, exit_code);
  };
  add("info", "prints the contents of a store", print_map_info)
      ->add_flag("--json", options->json,
                 "prints JSON: nodes, alignments and submaps by robot, and the hash of the set");
  add_export_options(
      *add("export", "writes the merged map as LAS or GeoTIFF, or in ENU as PLY or PCD", write_map),
      *options);
  add("picture", "draws the merged map from above and in perspective, by robot and density", draw_map)
      ->add_option("--out", options->out, "folder for the PNG files")
      ->required()
      ->check(some_path());
  CLI::App* tracks = add("tracks", "writes the trajectories of all robots as placed, in WGS84", write_tracks);
  tracks->add_option("--out", options->out, "FILE.gpx or FILE.geojson")
      ->required()
      ->check(file_ending({".gpx", ".geojson"}));
  tracks->add_option(
      "--geoid", options->las.geoid,
      "heights of GPX above this geoid of GeographicLib (egm2008-5); else above the ellipsoid");
  add("graph", "writes nodes, odometry and alignments in use for g2o", write_graph)
      ->add_option("--out", options->out, "FILE.g2o")
      ->required()
      ->check(file_ending({".g2o"}));
  add_map_merge(*command, exit_code);
  add_map_diff(*command, exit_code);
}

}  // namespace fleetmap::apps
