#include "shown_run.hpp"

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include "fleetmap/output/map_recipe.hpp"
#include "fleetmap/output/placed_store.hpp"
#include "stored_map.hpp"

namespace fleetmap::apps {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  if (std::ifstream in(file, std::ios::binary); in) text << in.rdbuf();
  return std::move(text).str();
}

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

/// registrations.csv beside the store of `by`.
void add_attempts(const fs::path& folder, const AgentId& by, monitor::FleetView& view) {
  const fs::path file = folder / "registrations.csv";
  monitor::Attempts read = monitor::parse_attempts(text_of(file), by);
  if (read.damaged > 0)
    view.notes.push_back(file.string() + ": " + std::to_string(read.damaged) + " lines cannot be read");
  std::ranges::move(read.attempts, std::back_inserter(view.attempts));
}

Result<std::unique_ptr<store::Store>> open_store(const fs::path& file) {
  if (const Status meant = check_store(file); !meant) return tl::unexpected(meant.error());
  auto store = store::Store::open_read_only(file);
  if (!store) return tl::unexpected(store.error());
  return std::make_unique<store::Store>(std::move(*store));
}

/// Places what the store holds as the robot's own last map did.
Status place_held(const store::Store& store, const fs::path& file, monitor::FleetView& view) {
  const auto kept = output::map_recipe(store);
  const output::MapRecipe recipe = kept.value_or(output::MapRecipe{});
  const auto origin = kept ? std::optional(kept->origin) : output::site_origin(store, std::nullopt);
  if (!origin) return failure(file.string() + ": holds no node, so there is nothing to show");
  view.self = store.self();
  view.origin = *origin;
  view.nodes = output::nodes_of(store);
  view.alignments = output::alignments_of(store);
  std::map<AgentId, NodeId> last;
  for (const graph::Node& node : view.nodes) {
    view.has_submap.push_back(store.has_submap(node.id));
    last[node.id.agent] = node.id;
  }
  std::vector<NodeId> covariance_of;
  for (const auto& [robot, id] : last) covariance_of.push_back(id);
  view.placement = output::place(store, *origin, recipe.placement, covariance_of);
  return {};
}

}  // namespace

Result<ShownRun> open_one(const fs::path& file) {
  auto store = open_store(file);
  if (!store) return tl::unexpected(store.error());
  ShownRun run{std::move(*store), {}};
  run.view.title = file.string();
  if (const Status placed = place_held(*run.store, file, run.view); !placed)
    return tl::unexpected(placed.error());
  add_holdings(*run.store, run.view.holdings);
  add_attempts(file.parent_path(), run.store->self(), run.view);
  return run;
}

std::vector<fs::path> robot_folders(const fs::path& directory) {
  std::vector<fs::path> folders;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(directory, error)) {
    if (fs::exists(entry.path() / "store.db", error)) folders.push_back(entry.path());
  }
  std::ranges::sort(folders);
  return folders;
}

Result<ShownRun> open_run(const fs::path& directory, const std::string& robot) {
  ShownRun run;
  fs::path shown;
  for (const fs::path& folder : robot_folders(directory)) {
    auto store = open_store(folder / "store.db");
    if (!store) {
      run.view.notes.push_back(store.error().message);
      continue;
    }
    add_holdings(**store, run.view.holdings);
    add_attempts(folder, (*store)->self(), run.view);
    const bool wanted = robot.empty() ? !run.store || (*store)->nodes().size() > run.store->nodes().size()
                                      : (*store)->self().str() == robot;
    if (!wanted) continue;
    run.store = std::move(*store);
    shown = folder / "store.db";
  }
  if (!run.store)
    return failure(directory.string() + ": holds no " +
                   (robot.empty() ? "robot's store.db" : "store of " + robot) + "; give the --out of a run");
  run.view.title = fs::weakly_canonical(directory).filename().string();
  if (const Status placed = place_held(*run.store, shown, run.view); !placed)
    return tl::unexpected(placed.error());
  return run;
}

}  // namespace fleetmap::apps
