#include "loaded_run.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "fleetmap/core/paths.hpp"
#include "fleetmap/core/text_list.hpp"
#include "fleetmap/output/line_file.hpp"
#include "fleetmap/output/map_recipe.hpp"
#include "fleetmap/output/placed_store.hpp"
#include "fleetmap/output/registrations_file.hpp"
#include "fleetmap/output/robot_folders.hpp"
#include "maps/stored_map.hpp"
#include "report/candidate_report.hpp"

namespace fleetmap::apps {

namespace fs = std::filesystem;

namespace {

void add_holdings(const store::Store& store, std::vector<monitor::Holding>& holdings) {
  std::map<AgentId, monitor::Holding> by_maker;
  const auto of = [&](const AgentId& maker) -> monitor::Holding& {
    monitor::Holding& holding = by_maker[maker];
    holding.holder = store.self();
    holding.maker = maker;
    return holding;
  };
  for (const auto& [id, node] : store.nodes()) {
    ++of(id.agent).nodes;
    of(id.agent).submaps += store.has_submap(id);
  }
  for (const auto& [id, alignment] : store.alignments()) ++of(id.computed_by).alignments;
  for (const auto& [maker, holding] : by_maker) holdings.push_back(holding);
}

/// Adds the candidates that the report of a robot, or of a whole run, has.
void add_candidates(const RobotFiles& files, monitor::FleetView& view) {
  std::ranges::move(reported_candidates(report_of(files), files.robot), std::back_inserter(view.candidates));
}

/// Removes what the robots in `without` did, and what others did with it.
void leave_out(std::span<const AgentId> without, monitor::FleetView& view) {
  if (without.empty()) return;
  const auto left_out = [&](const AgentId& robot) {
    return std::ranges::find(without, robot) != without.end();
  };
  std::erase_if(view.attempts, [&](const monitor::Attempt& one) {
    return left_out(one.by) || left_out(one.target.agent) || left_out(one.source.agent);
  });
  std::erase_if(view.candidates,
                [&](const monitor::PairCandidates& one) { return left_out(one.by) || left_out(one.with); });
  std::erase_if(view.holdings,
                [&](const monitor::Holding& one) { return left_out(one.holder) || left_out(one.maker); });
  std::erase_if(view.logs, left_out);
  if (left_out(view.self)) view.self = {};
  std::string names;
  for (const AgentId& robot : without) append_to_list(names, robot.str());
  view.notes.push_back("left out (--without): " + names);
}

Result<std::unique_ptr<store::Store>> open_store(const fs::path& file) {
  if (const Status meant = check_store(file); !meant) return tl::unexpected(meant.error());
  auto store = store::Store::open_read_only(file);
  if (!store) return tl::unexpected(store.error());
  return std::make_unique<store::Store>(std::move(*store));
}

/// Nodes whose covariance is computed: the last one of each robot, and some of all, since each costs a
/// solution.
std::vector<NodeId> with_covariance(const std::vector<graph::Node>& nodes) {
  constexpr std::size_t kOfAll = 32;
  std::set<NodeId> chosen;
  std::map<AgentId, NodeId> last;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    last[nodes[k].id.agent] = nodes[k].id;
    if (k % (nodes.size() / kOfAll + 1) == 0) chosen.insert(nodes[k].id);
  }
  for (const auto& [robot, id] : last) chosen.insert(id);
  return {chosen.begin(), chosen.end()};
}

/// Places what the store holds as the robot's own last map did.
Status place_held(const store::Store& store, const fs::path& file, std::span<const AgentId> without,
                  monitor::FleetView& view) {
  const auto recipe = output::recipe_or_default(store);
  if (!recipe) return failure(file.string() + ": holds no node, so there is nothing to show");
  view.self = store.self();
  view.origin = recipe->origin;
  view.search_radius_m = recipe->search_radius_m;
  auto items = output::items_without(store, without);
  if (!items) return tl::unexpected(items.error());
  view.nodes = std::move(items->nodes);
  view.alignments = std::move(items->alignments);
  for (const graph::Node& node : view.nodes) view.has_submap.push_back(store.has_submap(node.id));
  view.placement = graph::compute_placement(view.nodes, view.alignments, LocalFrame(recipe->origin),
                                            recipe->placement, with_covariance(view.nodes));
  return {};
}

}  // namespace

monitor::FleetView view_of(const store::Store& store, const output::Results& results) {
  monitor::FleetView view;
  view.self = store.self();
  view.origin = results.origin;
  if (const auto recipe = output::map_recipe(store)) view.search_radius_m = recipe->search_radius_m;
  view.placement = results.placement;
  for (const auto& [id, node] : store.nodes()) {
    view.nodes.push_back(node);
    view.has_submap.push_back(store.has_submap(id));
  }
  for (const auto& [id, alignment] : store.alignments()) view.alignments.push_back(alignment);
  add_holdings(store, view.holdings);
  return view;
}

void add_attempts(const fs::path& folder, const AgentId& by, monitor::FleetView& view) {
  const fs::path file = folder / output::kRegistrationsFile;
  if (output::parts_of(file).empty()) return;
  if (!std::ifstream(file)) {
    view.notes.push_back(file.string() + " cannot be read: may this user read it?");
    return;
  }
  view.logs.push_back(by);
  const output::Registrations read = output::read_registrations(file);
  if (auto note = output::damage_note(read.damaged, file)) view.notes.push_back(std::move(*note));
  for (const output::RegistrationRow& row : read.rows) {
    view.attempts.push_back({by, row.target, row.source, row.verdict, row.rmse, row.inlier_fraction,
                             row.overlap, row.reason, row.T_target_source, row.done});
  }
}

Result<LoadedRun> open_one(const fs::path& file, std::span<const AgentId> without) {
  auto store = open_store(file);
  if (!store) return tl::unexpected(store.error());
  LoadedRun run;
  run.store = std::move(*store);
  run.view.title = file.string();
  if (const Status placed = place_held(*run.store, file, without, run.view); !placed)
    return tl::unexpected(placed.error());
  add_holdings(*run.store, run.view.holdings);
  add_attempts(file.parent_path(), run.store->self(), run.view);
  run.files = {{run.store->self(), file.parent_path(), file}};
  add_candidates(run.files.front(), run.view);
  leave_out(without, run.view);
  return run;
}

std::vector<fs::path> robot_stores(const fs::path& directory) {
  std::vector<fs::path> stores;
  for (const fs::path& folder : output::robot_folders(directory, "store.db"))
    stores.push_back(folder / "store.db");
  return stores;
}

Result<LoadedRun> open_run(const fs::path& directory, const std::string& robot,
                           std::span<const AgentId> without) {
  if (!is_folder(directory)) return failure(directory.string() + ": no such folder; give the --out of a run");
  LoadedRun run;
  fs::path shown;
  for (const fs::path& file : robot_stores(directory)) {
    auto store = open_store(file);
    if (!store) {
      run.view.notes.push_back(store.error().message);
      continue;
    }
    add_holdings(**store, run.view.holdings);
    add_attempts(file.parent_path(), (*store)->self(), run.view);
    run.files.push_back({(*store)->self(), file.parent_path(), file});
    add_candidates(run.files.back(), run.view);
    const bool wanted = robot.empty() ? !run.store || (*store)->nodes().size() > run.store->nodes().size()
                                      : (*store)->self().str() == robot;
    if (!wanted) continue;
    run.store = std::move(*store);
    shown = file;
  }
  if (!run.store)
    return failure(directory.string() + ": holds no " +
                   (robot.empty() ? "robot's store.db" : "store of " + robot) + "; give the --out of a run");
  run.files.push_back({run.store->self(), directory, shown});
  add_candidates(run.files.back(), run.view);
  run.view.title = fs::weakly_canonical(directory).filename().string();
  if (const Status placed = place_held(*run.store, shown, without, run.view); !placed)
    return tl::unexpected(placed.error());
  leave_out(without, run.view);
  return run;
}

}  // namespace fleetmap::apps
