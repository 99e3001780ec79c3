#pragma once

#include <condition_variable>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "fleetmap/monitor/server.hpp"
#include "loaded_run.hpp"

namespace fleetmap::apps {

/// Serves the page of files that a robot or a run still writes, and shows them anew when they have changed.
/// Threads of its own read and place them, so a robot neither waits for a viewer nor copies anything for one.
/// They take about a twentieth of a core: after each reading they pause for twenty times the CPU time that it
/// took, 15 s at most.
class LiveMonitor {
 public:
  using Read = std::function<Result<LoadedRun>()>;
  using Stores = std::function<std::vector<std::filesystem::path>()>;

  /// `stores`: the files that are watched, if there are any yet. A reading that fails later leaves what was
  /// shown, and is tried again.
  /// Fails if the address cannot be listened on, or, unless `patient`, if there is nothing to show yet.
  static Result<std::unique_ptr<LiveMonitor>> start(const monitor::ServerConfig& config, Stores stores,
                                                    Read read, bool patient);
  ~LiveMonitor();
  LiveMonitor(const LiveMonitor&) = delete;
  LiveMonitor& operator=(const LiveMonitor&) = delete;

  monitor::Server& server() const { return *server_; }

 private:
  LiveMonitor(Stores stores, Read read);
  void follow();
  Result<cloud::PointCloud> load(const NodeId& id, const ContentHash& hash);
  Status show_if_changed();
  /// The last view again, with the reason why there is no newer one. Once, until something can be read again.
  void show_stale(const std::string& why);

  const Stores stores_;
  const Read read_;
  std::mutex mutex_;  ///< of `stop_` and `store_`
  std::condition_variable stopped_;
  bool stop_ = false;
  std::mutex reading_;  ///< of the store that is shown, whose submaps are decoded on several threads
  std::shared_ptr<store::Store> store_;
  std::optional<std::string> shown_;  ///< fingerprint of the files that are shown; none before the first
  std::shared_ptr<const monitor::FleetView> view_;  ///< that is shown
  bool stale_ = false;                              ///< it could not be read again
  std::string replaced_;  ///< a note, once another store has taken the place of the one that was shown
  std::string failed_;    ///< why the last reading failed, which is said once
  std::unique_ptr<monitor::Server> server_;
  std::thread thread_;
};

/// The page of what the robot that keeps its files in `folder` holds; null without a configuration.
Result<std::unique_ptr<LiveMonitor>> page_of_robot(const std::optional<monitor::ServerConfig>& config,
                                                   const std::filesystem::path& folder);
/// The same of all robots below `directory`, on the map of the one that holds most.
Result<std::unique_ptr<LiveMonitor>> page_of_run(const std::optional<monitor::ServerConfig>& config,
                                                 const std::filesystem::path& directory);

}  // namespace fleetmap::apps
