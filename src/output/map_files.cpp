#include "fleetmap/output/map_files.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "fleetmap/cloud/cloud_writer.hpp"
#include "fleetmap/core/file_hash.hpp"
#include "fleetmap/graph/frame_name.hpp"
#include "fleetmap/store/submap_loader.hpp"

namespace fleetmap::output {
namespace {

constexpr std::array kMapNames{"map.ply", "map.pcd"};

Result<MapFiles> copied_map(const MapFiles& other, const std::filesystem::path& directory) {
  for (const char* name : kMapNames) {
    std::error_code error;
    std::filesystem::copy_file(other.directory / name, directory / name,
                               std::filesystem::copy_options::overwrite_existing, error);
    if (error) return failure((directory / name).string() + ": cannot be written: " + error.message());
  }
  MapFiles files = other;
  files.directory = directory;
  return files;
}

void warn_of_unreadable(const store::MapOutline& outline, const AgentId& self) {
  for (const NodeId& id : outline.unreadable)
    spdlog::warn("{}: submap of {} cannot be read and is left out", self.str(), to_string(id));
}

}  // namespace

store::MergedMap merged_map(store::Store& store, const std::map<NodeId, Pose>& T_map_node,
                            const store::MergeConfig& config) {
  return store::merge(store::with_submaps(store, T_map_node), store::decoded_submaps(store), config);
}

Result<store::TiledMerge> tiled_map(store::Store& store, const std::map<NodeId, Pose>& T_map_node,
                                    const store::MergeConfig& config, store::SubmapLoader load) {
  if (!load) load = store::decoded_submaps(store);
  return store::TiledMerge::plan(store::with_submaps(store, T_map_node), std::move(load), config);
}

Status require_points(const store::MapOutline& outline) {
  const auto no_point = [](const std::string& why) { return failure("the map has no point: " + why); };
  if (!outline.unreadable.empty() && outline.submaps == 0)
    return no_point("none of its " + std::to_string(outline.unreadable.size()) +
                    " submaps can be read, so the store is damaged; use that of another robot");
  if (outline.submaps == 0)
    return no_point("no submap of its nodes is held; use the store of a robot that holds them");
  if (outline.points_in == 0)
    return no_point("its " + std::to_string(outline.submaps) + " submaps are empty");
  if (outline.points_in > outline.points_refused) return {};
  return no_point("all " + std::to_string(outline.points_in) +
                  " points are too far from the origin of ENU; give an origin at the site (--origin)");
}

Result<WrittenMap> write_merged(store::Store& store, const std::map<NodeId, Pose>& T_map_node,
                                const store::MergeConfig& config,
                                std::span<const std::filesystem::path> files,
                                const std::vector<std::string>& comments, const store::SubmapLoader& load) {
  auto merge = tiled_map(store, T_map_node, config, load);
  if (!merge) return tl::unexpected(merge.error());
  return write_planned(*merge, files, comments);
}

Result<WrittenMap> write_planned(store::TiledMerge& merge, std::span<const std::filesystem::path> files,
                                 const std::vector<std::string>& comments) {
  std::vector<cloud::CloudWriter> writers;
  for (const std::filesystem::path& file : files) {
    auto writer = cloud::CloudWriter::create(file, merge.outline().has_intensities, comments);
    if (!writer) return tl::unexpected(writer.error());
    writers.push_back(std::move(*writer));
  }
  WrittenMap written;
  const Status streamed = merge.stream([&](const store::MapTile& tile) -> Status {
    written.points += tile.cloud.size();
    for (cloud::CloudWriter& writer : writers) {
      if (const Status added = writer.add(tile.cloud); !added) return added;
    }
    return {};
  });
  if (!streamed) return tl::unexpected(streamed.error());
  for (cloud::CloudWriter& writer : writers) {
    if (const Status finished = writer.finish(); !finished) return tl::unexpected(finished.error());
  }
  written.outline = merge.outline();
  return written;
}

ContentHash map_hash(const store::Store& store, const std::map<NodeId, Pose>& T_map_node,
                     const store::MergeConfig& config) {
  Bytes inputs;
  const auto add = [&inputs](const auto& value) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
    inputs.insert(inputs.end(), bytes, bytes + sizeof(value));
  };
  add(config.voxel_m);
  add(config.centroids);
  for (const auto& [id, T] : T_map_node) {
    const graph::Node* node = store.node(id);
    if (node == nullptr || !store.has_submap(id)) continue;
    for (const char c : id.agent.str()) add(c);
    add(id.seq);
    add(node->submap_hash);
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 3; ++row) add(T.matrix()(row, column));
  }
  return content_hash(inputs);
}

Result<MapFiles> write_map(store::Store& store, const std::map<NodeId, Pose>& T_map_node,
                           const store::MergeConfig& config, const std::filesystem::path& directory,
                           std::span<const MapFiles> others, const std::vector<std::string>& comments,
                           const store::SubmapLoader& load) {
  MapFiles files;
  files.directory = directory;
  files.made_of = map_hash(store, T_map_node, config);
  if (const auto same = std::ranges::find(others, files.made_of, &MapFiles::made_of); same != others.end())
    return copied_map(*same, directory);
  std::vector<std::filesystem::path> paths;
  for (const char* name : kMapNames) paths.push_back(directory / name);
  const auto map = write_merged(store, T_map_node, config, paths, comments, load);
  if (!map) return tl::unexpected(map.error());
  warn_of_unreadable(map->outline, store.self());
  if (!map->outline.unreadable.empty()) files.made_of = {};  // not for others
  const auto hash = file_hash(paths.front());
  if (!hash) return tl::unexpected(hash.error());
  files.hash = to_hex(*hash);
  files.points = map->points;
  files.submaps = map->outline.submaps;
  return files;
}

Result<std::size_t> write_part(store::Store& store, const MapPart& part, const store::MergeConfig& config,
                               const std::filesystem::path& directory,
                               const std::vector<std::string>& comments, const store::SubmapLoader& load) {
  const std::filesystem::path file = directory / file_of(part);
  const auto map = write_merged(store, part.T_map_node, config, std::array{file}, comments, load);
  if (!map) return tl::unexpected(map.error());
  warn_of_unreadable(map->outline, store.self());
  spdlog::warn("{}: nobody knows where {} lies: {} submaps are in {}, not in map.ply", store.self().str(),
               to_string(part.frames.front()), map->outline.submaps, file.string());
  return map->outline.submaps;
}

void remove_parts(const std::filesystem::path& directory) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(directory, error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("map-") && name.ends_with(".ply")) std::filesystem::remove(entry.path(), error);
  }
}

void remove_unfinished_maps(const std::filesystem::path& directory) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(directory, error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("map") && name.ends_with(".part")) std::filesystem::remove(entry.path(), error);
  }
}

}  // namespace fleetmap::output
