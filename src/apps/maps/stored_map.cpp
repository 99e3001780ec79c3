#include "stored_map.hpp"

#include <fstream>
#include <iostream>
#include <string>
#include <string_view>
#include <utility>

#include "fleetmap/core/paths.hpp"
#include "fleetmap/output/map_holes.hpp"
#include "fleetmap/store/thinned_map.hpp"

namespace fleetmap::apps {

// A file that SQLite would call damaged, or a disk error, is most often another one than was meant.
Status check_store(const std::filesystem::path& file) {
  if (is_folder(file)) return failure(file.string() + ": is a folder; give the store.db of a robot in it");
  if (!is_there(file)) return failure(file.string() + ": no such file; give the store.db of a robot");
  constexpr std::string_view kStart = "SQLite format 3";
  std::string start(kStart.size(), ' ');
  std::ifstream in(file, std::ios::binary);
  if (!in) return failure(file.string() + ": cannot be read; check its permissions");
  if (!in.read(start.data(), static_cast<std::streamsize>(start.size())) || start != kStart)
    return failure(file.string() + ": is no store; give the store.db of a robot");
  return {};
}

Result<std::vector<AgentId>> robots_named(const std::vector<std::string>& names) {
  std::vector<AgentId> robots;
  for (const std::string& name : names) {
    const auto robot = AgentId::parse(name);
    if (!robot) return tl::unexpected(robot.error());
    robots.push_back(*robot);
  }
  return robots;
}

Result<StoredMap> open_map(const std::filesystem::path& file, const MapSelection& selection) {
  if (const Status meant = check_store(file); !meant) return tl::unexpected(meant.error());
  auto store = store::Store::open_read_only(file);
  if (!store) return tl::unexpected(store.error());
  auto recipe = output::recipe_or_default(*store, selection.origin);
  if (!recipe || store->nodes().empty())
    return failure(file.string() + ": holds no node, so there is no map");
  if (!is_valid(recipe->origin))
    return failure("--origin is not on Earth; expected latitude_deg,longitude_deg,altitude_m");
  if (selection.voxel_m) recipe->merge.voxel_m = *selection.voxel_m;
  auto items = output::items_without(*store, selection.without);
  if (!items) return tl::unexpected(items.error());
  auto placement = graph::compute_placement(items->nodes, items->alignments, LocalFrame(recipe->origin),
                                            recipe->placement);
  return StoredMap{std::move(*store), *recipe, std::move(*items), std::move(placement)};
}

std::map<NodeId, Pose> shown_poses(const StoredMap& map) {
  return output::map_parts(map.items.nodes, map.placement).main.T_map_node;
}

void name_holes(const StoredMap& map) {
  if (const std::string holes = output::text_of_holes(map.store, map.items.nodes); !holes.empty())
    std::cerr << holes << '\n';
}

void name_unreadable(const store::MapOutline& outline) {
  for (const NodeId& id : outline.unreadable)
    std::cerr << "submap of " << to_string(id) << " cannot be read and is left out\n";
}

Result<std::vector<run_evaluation::MapPicture>> pictures_of(StoredMap& map) {
  constexpr double kDensityRadius = 1.0;  // m
  auto merge = output::tiled_map(map.store, shown_poses(map), map.recipe.merge);
  if (!merge) return tl::unexpected(merge.error());
  store::ThinnedMap thinned(map.recipe.merge.voxel_m, run_evaluation::kMaxDrawn);
  const auto thin = [&](const store::MapTile& tile) -> Status {
    thinned.add(tile);
    return {};
  };
  if (const Status done = merge->stream(thin); !done) return tl::unexpected(done.error());
  name_unreadable(merge->outline());
  const store::MergedMap shown = thinned.map(merge->outline());
  auto pictures = run_evaluation::pictures_by_robot(shown);
  if (!pictures) return pictures;
  std::vector<std::uint32_t> counts(shown.cloud.size());
  const auto count = [&](const store::MapTile& tile) -> Status {
    run_evaluation::add_density(shown.cloud, tile.cloud, kDensityRadius, counts);
    return {};
  };
  if (const Status done = merge->stream(count); !done) return tl::unexpected(done.error());
  auto density = run_evaluation::picture_of_density(shown.cloud, counts, kDensityRadius);
  if (density) pictures->push_back(std::move(*density));
  return pictures;
}

}  // namespace fleetmap::apps
