#include <algorithm>
#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <mutex>
#include <sstream>
#include <string>
#include <vector>

#include "commands.hpp"
#include "fleetmap/monitor/request_check.hpp"
#include "fleetmap/monitor/server.hpp"
#include "fleetmap/output/map_recipe.hpp"
#include "fleetmap/output/placed_store.hpp"
#include "fleetmap/output/registrations_file.hpp"
#include "fleetmap/store/submap_loader.hpp"
#include "options.hpp"
#include "stored_map.hpp"

namespace fleetmap::apps {
namespace {

namespace fs = std::filesystem;

struct MonitorOptions {
  std::string store, run, robot;
  std::string address = "127.0.0.1";
  std::string token_file;
  std::uint16_t port = 8080;
  std::size_t viewers = 8;
};

/// What was found of a finished run: the view of one robot, and its store, which holds the submaps.
struct FinishedRun {
  std::unique_ptr<store::Store> store;
  monitor::FleetView view;
};

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  if (std::ifstream in(file, std::ios::binary); in) text << in.rdbuf();
  return std::move(text).str();
}

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
  const fs::path file = folder / output::kRegistrationsFile;
  const output::Registrations read = output::read_registrations(file);
  if (auto note = output::damage_note(read, file)) view.notes.push_back(std::move(*note));
  for (const output::RegistrationRow& row : read.rows) {
    view.attempts.push_back(
        {by, row.target, row.source, row.verdict, row.rmse, row.inlier_fraction, row.overlap, row.reason});
  }
}

Result<std::unique_ptr<store::Store>> open_store(const fs::path& file) {
  if (const Status meant = check_store(file); !meant) return tl::unexpected(meant.error());
  auto store = store::Store::open_read_only(file);
  if (!store) return tl::unexpected(store.error());
  return std::make_unique<store::Store>(std::move(*store));
}

/// Places what the store holds as the robot's own last map did.
Status place_held(const store::Store& store, const fs::path& file, monitor::FleetView& view) {
  const auto recipe = output::recipe_or_default(store);
  if (!recipe) return failure(file.string() + ": holds no node, so there is nothing to show");
  view.self = store.self();
  view.origin = recipe->origin;
  view.nodes = output::nodes_of(store);
  view.alignments = output::alignments_of(store);
  std::map<AgentId, NodeId> last;
  for (const graph::Node& node : view.nodes) {
    view.has_submap.push_back(store.has_submap(node.id));
    last[node.id.agent] = node.id;
  }
  std::vector<NodeId> covariance_of;
  for (const auto& [robot, id] : last) covariance_of.push_back(id);
  view.placement = output::place(store, recipe->origin, recipe->placement, covariance_of);
  return {};
}

Result<FinishedRun> open_one(const fs::path& file) {
  auto store = open_store(file);
  if (!store) return tl::unexpected(store.error());
  FinishedRun run{std::move(*store), {}};
  run.view.title = file.string();
  if (const Status placed = place_held(*run.store, file, run.view); !placed)
    return tl::unexpected(placed.error());
  add_holdings(*run.store, run.view.holdings);
  add_attempts(file.parent_path(), run.store->self(), run.view);
  return run;
}

/// The folders of a run that hold a store, by name.
std::vector<fs::path> robot_folders(const fs::path& directory) {
  std::vector<fs::path> folders;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(directory, error)) {
    if (fs::exists(entry.path() / "store.db", error)) folders.push_back(entry.path());
  }
  std::ranges::sort(folders);
  return folders;
}

/// All robots of a run, on the map of one: of `robot`, or of the one that holds most.
Result<FinishedRun> open_run(const fs::path& directory, const std::string& robot) {
  FinishedRun run;
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

Result<monitor::ServerConfig> server_config(const MonitorOptions& options) {
  monitor::ServerConfig config;
  config.address = options.address;
  config.port = options.port;
  config.max_viewers = options.viewers;
  if (!options.token_file.empty()) {
    config.token = text_of(options.token_file);
    while (!config.token.empty() && std::isspace(static_cast<unsigned char>(config.token.back())))
      config.token.pop_back();
    const bool plain =
        std::ranges::all_of(config.token, [](char c) { return std::isalnum(static_cast<unsigned char>(c)); });
    if (config.token.size() < monitor::kMinTokenLength || !plain)
      return failure(options.token_file + ": expected a token of at least 16 letters and digits");
  } else if (!monitor::is_loopback(options.address)) {
    config.token = monitor::random_token();
  }
  return config;
}

void wait_for_signal() {
  const std::atomic<bool>& stop = stop_on_signals();
  std::mutex mutex;
  std::condition_variable never;
  std::unique_lock lock(mutex);
  // A signal handler may notify nobody.
  while (!stop) never.wait_for(lock, std::chrono::milliseconds(200));
}

int show(const MonitorOptions& options) {
  if (options.store.empty() == options.run.empty())
    return report({"give either --store FILE or --run DIR"}, kUsage);
  auto config = server_config(options);
  if (!config) return report(config.error(), kUsage);
  if (const Status valid = config->validate(); !valid) return report(valid.error(), kUsage);
  auto run = options.store.empty() ? open_run(options.run, options.robot) : open_one(options.store);
  if (!run) return report(run.error(), kFailed);
  auto server = monitor::Server::start(*config, store::decoded_submaps(*run->store));
  if (!server) return report(server.error(), kFailed);
  (*server)->publish(std::make_shared<const monitor::FleetView>(std::move(run->view)));
  if (const std::string why = monitor::why_no_page(); !why.empty()) std::cerr << why << '\n';
  std::cout << "open " << (*server)->url() << " in a browser; Ctrl-C ends\n" << std::flush;
  wait_for_signal();
  return kDone;
}

}  // namespace

void add_monitor(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<MonitorOptions>();
  CLI::App* command =
      app.add_subcommand("monitor", "shows a finished run in a browser: map, fleet, registrations");
  command->add_option("--store", options->store, "store.db of a robot")->check(some_path());
  command->add_option("--run", options->run, "folder that `run` or the agents wrote to")->check(some_path());
  command->add_option("--robot", options->robot,
                      "of --run: whose map is shown; else of the one that holds most");
  command->add_option("--port", options->port, "TCP port, 0 for any that is free")
      ->check(whole_number(0, 65535));
  command->add_option("--address", options->address,
                      "address to listen on; any but 127.0.0.1 needs the token that is printed");
  command->add_option("--token-file", options->token_file, "file with the token, instead of a random one")
      ->check(some_path());
  command->add_option("--viewers", options->viewers, "pages that may be open at once")
      ->check(whole_number(1, 64));
  command->callback([options, &exit_code] { exit_code = show(*options); });
}

}  // namespace fleetmap::apps
