#include <iomanip>
#include <iostream>
#include <memory>
#include <numbers>

#include "commands.hpp"
#include "fleetmap/agent/results.hpp"
#include "fleetmap/cloud/file_io.hpp"
#include "options.hpp"

namespace fleetmap::apps {
namespace {

struct MapOptions {
  std::string store;
  std::string out;
  double voxel = 0.1;
  std::vector<double> origin_deg;
};

std::optional<GeoPoint> configured_origin(const MapOptions& options) {
  if (options.origin_deg.empty()) return std::nullopt;
  return geo_point_from_degrees(options.origin_deg[0], options.origin_deg[1], options.origin_deg[2]);
}

struct OpenedMap {
  store::Store store;
  GeoPoint origin;
  graph::Placement placement;
};

Result<OpenedMap> open_map(const MapOptions& options) {
  auto store = store::Store::open_read_only(options.store);
  if (!store) return tl::unexpected(store.error());
  const auto origin = agent::site_origin(*store, configured_origin(options));
  if (!origin) return failure(options.store + ": holds no node, so there is no map");
  if (!is_valid(*origin))
    return failure("--origin is not on Earth; expected latitude_deg,longitude_deg,altitude_m");
  auto placement = agent::place(*store, *origin, {});
  return OpenedMap{std::move(*store), *origin, std::move(placement)};
}

int info(const MapOptions& options) {
  const auto map = open_map(options);
  if (!map) return report(map.error(), kFailed);
  constexpr double kDegree = std::numbers::pi / 180.0;
  std::cout << "store of " << map->store.self().str() << '\n'
            << "nodes " << map->store.nodes().size() << ", submaps held " << map->store.submap_set().size()
            << ", alignments " << map->store.alignments().size() << " (" << map->placement.used.size()
            << " used)\n"
            << std::setprecision(10) << "origin " << map->origin.latitude / kDegree << ", "
            << map->origin.longitude / kDegree << " deg, " << map->origin.altitude << " m\n";
  for (const auto& component : map->placement.components) {
    std::cout << "aligned together:";
    for (const graph::FrameId& frame : component) std::cout << ' ' << agent::to_string(frame);
    std::cout << '\n';
  }
  return kDone;
}

int export_map(const MapOptions& options) {
  auto map = open_map(options);
  if (!map) return report(map.error(), kFailed);
  store::MergeConfig config;
  config.voxel_m = options.voxel;
  if (const Status valid = config.validate(); !valid) return report(valid.error(), kUsage);
  const store::MergedMap merged = agent::merged_map(map->store, map->placement, config);
  for (const NodeId& id : merged.unreadable)
    std::cerr << "submap of " << to_string(id) << " cannot be read and is left out\n";
  if (const Status written = cloud::write_cloud(options.out, merged.cloud); !written)
    return report(written.error(), kFailed);
  std::cout << options.out << ": " << merged.cloud.size() << " points from " << merged.submaps
            << " submaps\n";
  return kDone;
}

}  // namespace

void add_map(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<MapOptions>();
  CLI::App* command = app.add_subcommand("map", "looks into a store, or writes its map");
  command->require_subcommand(1);
  CLI::App* info_command = command->add_subcommand("info", "what a store holds");
  CLI::App* export_command = command->add_subcommand("export", "the merged map in ENU as PLY or PCD");
  for (CLI::App* sub : {info_command, export_command}) {
    sub->add_option("store", options->store, "store.db of an agent")->required();
    sub->add_option("--origin", options->origin_deg,
                    "latitude_deg,longitude_deg,altitude_m of ENU; else the least node's")
        ->delimiter(',')
        ->expected(3);
  }
  export_command->add_option("--out", options->out, "FILE.ply or FILE.pcd")->required();
  export_command->add_option("--voxel", options->voxel, "m, one point is kept in each cube of this edge");
  info_command->callback([options, &exit_code] { exit_code = info(*options); });
  export_command->callback([options, &exit_code] { exit_code = export_map(*options); });
}

}  // namespace fleetmap::apps
