#include <condition_variable>
#include <iostream>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "commands.hpp"
#include "fleetmap/output/robot_folders.hpp"
#include "live_monitor.hpp"
#include "monitor_access.hpp"
#include "options.hpp"
#include "report.hpp"
#include "stored_map.hpp"

namespace fleetmap::apps {
namespace {

namespace fs = std::filesystem;

struct MonitorOptions {
  std::string store, run, robot;
  std::vector<std::string> without;
  MonitorAccess access;
};

void wait_for_signal() {
  const std::atomic<bool>& stop = stop_on_signals();
  std::mutex mutex;
  std::condition_variable never;
  std::unique_lock lock(mutex);
  // A signal handler may notify nobody.
  while (!stop) never.wait_for(lock, std::chrono::milliseconds(200));
}

int show(const MonitorOptions& options) {
  const bool one = !options.store.empty();
  if (one != options.run.empty()) return report({"give either --store FILE or --run DIR"}, kUsage);
  const auto config = server_config(options.access);
  if (!config) return report(config.error(), kUsage);
  const auto without = robots_named(options.without);
  if (!without) return report(without.error(), kUsage);
  const LiveMonitor::Read read = [&] {
    return one ? open_one(options.store, *without) : open_run(options.run, options.robot, *without);
  };
  const LiveMonitor::Folders folders = [&] {
    return one ? std::vector{fs::path(options.store).parent_path()}
               : output::robot_folders(options.run, "store.db");
  };
  const auto live = LiveMonitor::start(*config, folders, read, false);
  if (!live) return report(live.error(), kFailed);
  if (const std::string why = monitor::why_no_page(); !why.empty()) std::cerr << why << '\n';
  std::cout << "open " << (*live)->server().url() << " in a browser; Ctrl-C ends\n" << std::flush;
  wait_for_signal();
  return kDone;
}

}  // namespace

void add_monitor(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<MonitorOptions>();
  options->access.port = 8080;
  CLI::App* command = app.add_subcommand(
      "monitor", "shows a run in a browser, finished or still under way: map, fleet, registrations");
  command->add_option("--store", options->store, "store.db of a robot")->check(some_path());
  command->add_option("--run", options->run, "folder that `run` or the agents write to")->check(some_path());
  command->add_option("--robot", options->robot,
                      "of --run: whose map is shown; else of the one that holds most");
  command
      ->add_option("--without", options->without,
                   "robots, comma-separated, whose nodes and alignments are left out of the map")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("--port", options->access.port, "TCP port, 0 for any that is free")
      ->check(whole_number(0, 65535));
  add_access_options(*command, options->access, "");
  command->callback([options, &exit_code] { exit_code = show(*options); });
}

}  // namespace fleetmap::apps
