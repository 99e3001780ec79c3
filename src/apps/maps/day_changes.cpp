#include "day_changes.hpp"

#include <algorithm>
#include <iomanip>
#include <ostream>
#include <string>
#include <vector>

#include "fleetmap/change/change_files.hpp"
#include "fleetmap/core/work_folder.hpp"
#include "fleetmap/geometry/degree.hpp"
#include "fleetmap/output/lidar_mount.hpp"
#include "fleetmap/output/map_parts.hpp"
#include "fleetmap/output/placed_store.hpp"
#include "fleetmap/output/sea_level_heights.hpp"
#include "fleetmap/store/submap_loader.hpp"
#include "merged_store.hpp"

namespace fleetmap::apps {
namespace {

namespace fs = std::filesystem;

/// The submaps of the nodes of `day` that `other` does not have, as placed.
std::vector<change::ObservedSubmap> observed(store::Store& store, const graph::Placement& placement,
                                             const loop_closure::MapSession& day,
                                             const loop_closure::MapSession& other,
                                             const Eigen::Vector3d& lidar) {
  const store::SubmapLoader load = store::decoded_submaps(store);
  std::vector<change::ObservedSubmap> submaps;
  const graph::Node* previous = nullptr;
  for (const auto& [id, node] : store.nodes()) {
    const auto T = placement.T_enu_node.find(id);
    if (!day.contains(node.frame()) || other.contains(node.frame()) || T == placement.T_enu_node.end())
      continue;
    const auto points = load(id);
    if (points && !points->empty()) {
      Eigen::Vector3d sensor = T->second * lidar;
      // The points were seen on the way from the node before.
      if (previous != nullptr && previous->frame() == node.frame())
        sensor = 0.5 * (sensor + placement.T_enu_node.at(previous->id) * lidar);
      submaps.push_back({cloud::transformed(*points, T->second), sensor.cast<float>()});
    }
    previous = &node;
  }
  return submaps;
}

Result<Eigen::Vector3d> lidar_of(const fs::path& file) {
  const auto store = store::Store::open_read_only(file);
  if (!store) return tl::unexpected(store.error());
  return output::lidar_mount(*store).value_or(Eigen::Vector3d::Zero());
}

}  // namespace

Result<DayChanges> changes_between(const fs::path& first, const fs::path& second) {
  const WorkFolder folder("fleetmap_diff");
  const fs::path file = folder.path() / "merged.db";
  const auto merged = merge_stores({first, second}, file, std::nullopt);
  if (!merged) return tl::unexpected(merged.error());
  const DayPair& pair = merged->pairs.front();
  if (!pair.joined || pair.used == 0) {
    const std::string why =
        pair.joined ? "they share an odometry session, so they are no two days" : pair.why_not;
    return failure(first.string() + " and " + second.string() + " cannot be aligned: " + why);
  }
  const auto lidar_before = lidar_of(first), lidar_after = lidar_of(second);
  if (!lidar_before) return tl::unexpected(lidar_before.error());
  if (!lidar_after) return tl::unexpected(lidar_after.error());
  auto store = store::Store::open_read_only(file);
  if (!store) return tl::unexpected(store.error());
  const loop_closure::MapSession &before = merged->days[0], &after = merged->days[1];
  auto changes = change::find_changes(observed(*store, merged->placement, before, after, *lidar_before),
                                      observed(*store, merged->placement, after, before, *lidar_after), {});
  if (!changes) return failure(first.string() + " and " + second.string() + ": " + changes.error().message);
  DayChanges compared{std::move(*changes), pair.used, std::nullopt, output::has_sea_level_heights(*store),
                      pair.certainty};
  if (output::map_parts(output::nodes_of(*store), merged->placement).main.georeferenced)
    compared.origin = merged->recipe.origin;
  return compared;
}

void print_changes(std::ostream& out, const DayChanges& compared) {
  const change::Changes& found = compared.changes;
  const double whole = static_cast<double>(std::max<std::size_t>(1, found.compared + found.unknown));
  out << std::fixed << std::setprecision(2) << "aligned by " << compared.alignments
      << " alignments of the two days, which fit to " << found.misfit_m << " m, each of them to itself to "
      << found.noise_m << " m\n"
      << "certain to " << compared.certainty.median_m << " m and " << compared.certainty.median_rad / kDegree
      << " deg each in their least certain direction (1 sigma, median of the alignments; the worst of them "
         "to "
      << compared.certainty.largest_m << " m and " << compared.certainty.largest_rad / kDegree << " deg)\n"
      << std::setprecision(0) << 100.0 * static_cast<double>(found.compared) / whole
      << " % of the surfaces can be compared; of the others one day saw nothing\n"
      << std::setprecision(2) << "surfaces count as different from " << found.min_distance_m
      << " m on (median), changes from " << found.min_cells << " cells on\n";
  const auto count = [&](change::Kind kind) {
    return std::ranges::count(found.changes, kind, &change::Change::kind);
  };
  out << found.changes.size() << " changes: " << count(change::Kind::appeared) << " appeared, "
      << count(change::Kind::disappeared) << " disappeared\n";
  if (!found.changes.empty()) out << change::to_table(found, compared.origin);
}

}  // namespace fleetmap::apps
