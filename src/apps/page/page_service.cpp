#include "page_service.hpp"

#include <condition_variable>
#include <filesystem>
#include <iostream>
#include <mutex>
#include <string>
#include <vector>

#include "live_monitor.hpp"
#include "maps/stored_map.hpp"
#include "options.hpp"
#include "preview_files.hpp"
#include "run_radio.hpp"

namespace fleetmap::apps {
namespace {

namespace fs = std::filesystem;

void wait_for_signal() {
  const std::atomic<bool>& stop = stop_on_signals();
  std::mutex mutex;
  std::condition_variable never;
  std::unique_lock lock(mutex);
  // A signal handler must not notify a condition variable.
  while (!stop) never.wait_for(lock, std::chrono::milliseconds(200));
}

}  // namespace

CommandResult<ExitCode> serve_page(const MonitorOptions& options, std::ostream& out) {
  const bool one = !options.store.empty();
  if (one != options.run.empty()) return exit_with(kUsage, {"give either --store FILE or --run DIR"});
  auto config = server_config(options.access);
  if (!config) return exit_with(kUsage, config.error());
  config->preview_file = one ? previews_of_store(options.store) : previews_of_run(options.run);
  config->more_previews = one ? more_previews_of_store(options.store) : more_previews_of_run(options.run);
  const auto without = robots_named(options.without);
  if (!without) return exit_with(kUsage, without.error());
  const LiveMonitor::Read read = [&] {
    auto run = one ? open_one(options.store, *without) : open_run(options.run, options.robot, *without);
    if (run) add_radio(*run, *without);
    return run;
  };
  const LiveMonitor::Stores stores = [&] {
    return one ? std::vector{fs::path(options.store)} : robot_stores(options.run);
  };
  const auto live = LiveMonitor::start(*config, stores, read, false);
  if (!live) return exit_with(kFailed, live.error());
  if (const std::string why = monitor::why_no_page(); !why.empty()) std::cerr << why << '\n';
  out << "open " << (*live)->server().url() << " in a browser; Ctrl-C ends\n" << std::flush;
  wait_for_signal();
  return kDone;
}

}  // namespace fleetmap::apps
