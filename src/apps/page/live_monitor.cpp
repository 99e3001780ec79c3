#include "live_monitor.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <sstream>

#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/core/cpu_time.hpp"
#include "fleetmap/output/registrations_file.hpp"
#include "preview_files.hpp"

namespace fleetmap::apps {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kMinPause{2000};
constexpr int kPauseFactor = 20;    // of the CPU time that a reading takes
constexpr double kMaxPause = 15.0;  // s
constexpr unsigned kMaxPreviewThreads = 4;

/// Sizes and times of the files that a view is made of. SQLite writes to the log beside the store first.
std::string fingerprint(const std::vector<fs::path>& stores) {
  std::ostringstream print;
  for (const fs::path& store : stores) {
    for (const fs::path& file :
         {store, fs::path(store.string() + "-wal"), store.parent_path() / output::kRegistrationsFile,
          store.parent_path() / "report.json", store.parent_path().parent_path() / "report.json"}) {
      std::error_code missing;
      const auto bytes = fs::file_size(file, missing);
      if (missing) continue;
      const auto time = fs::last_write_time(file, missing);
      print << file.string() << ' ' << bytes << ' ' << time.time_since_epoch().count() << '\n';
    }
  }
  return std::move(print).str();
}

/// Nodes that are no longer there, or have another submap. A store only grows, unless it is replaced.
std::size_t nodes_lost(const monitor::FleetView& before, const monitor::FleetView& now) {
  std::map<NodeId, ContentHash> hashes;
  for (const graph::Node& node : now.nodes) hashes[node.id] = node.submap_hash;
  return static_cast<std::size_t>(std::ranges::count_if(before.nodes, [&](const graph::Node& node) {
    const auto found = hashes.find(node.id);
    return found == hashes.end() || found->second != node.submap_hash;
  }));
}

Result<std::unique_ptr<LiveMonitor>> open_page(const std::optional<monitor::ServerConfig>& config,
                                               fs::path previews, LiveMonitor::Stores stores,
                                               LiveMonitor::Read read) {
  if (!config) return nullptr;
  monitor::ServerConfig beside_robots = *config;
  beside_robots.background = true;
  beside_robots.preview_file = std::move(previews);
  auto page = LiveMonitor::start(beside_robots, std::move(stores), std::move(read), true);
  if (page) spdlog::info("page: open {} in a browser", (*page)->server().url());
  return page;
}

}  // namespace

LiveMonitor::LiveMonitor(Stores stores, Read read) : stores_(std::move(stores)), read_(std::move(read)) {}

Result<std::unique_ptr<LiveMonitor>> LiveMonitor::start(const monitor::ServerConfig& config, Stores stores,
                                                        Read read, bool patient) {
  auto live = std::unique_ptr<LiveMonitor>(new LiveMonitor(std::move(stores), std::move(read)));
  const auto load = [self = live.get()](const NodeId& id, const ContentHash& hash) {
    return self->load(id, hash);
  };
  monitor::ServerConfig with_previews = config;
  with_previews.preview_threads = std::clamp(std::thread::hardware_concurrency(), 1u, kMaxPreviewThreads);
  auto server = monitor::Server::start(with_previews, load);
  if (!server) return tl::unexpected(server.error());
  live->server_ = std::move(*server);
  if (const Status shown = live->show_if_changed(); !shown) {
    if (!patient) return tl::unexpected(shown.error());
    live->failed_ = shown.error().message;  // not worth a line: the robots have only begun
  }
  live->thread_ = std::thread([self = live.get()] { self->follow(); });
  return live;
}

LiveMonitor::~LiveMonitor() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  stopped_.notify_all();
  if (thread_.joinable()) thread_.join();
}

Result<cloud::PointCloud> LiveMonitor::load(const NodeId& id, const ContentHash& hash) {
  const auto encoded = [&]() -> Result<Bytes> {
    const std::lock_guard reading(reading_);
    std::unique_lock lock(mutex_);
    const auto store = store_;
    lock.unlock();
    return store ? store->submap(id) : failure("nothing is shown yet");
  }();
  if (!encoded) return tl::unexpected(encoded.error());
  // The store may be newer than the view, whose hash names these points in caches.
  if (content_hash(*encoded) != hash)
    return failure("the store was replaced, and holds another submap of " + to_string(id));
  return encoded->empty() ? cloud::PointCloud{} : cloud::decode(*encoded);
}

void LiveMonitor::follow() {
  std::chrono::milliseconds pause = kMinPause;
  while (true) {
    {
      std::unique_lock lock(mutex_);
      if (stopped_.wait_for(lock, pause, [this] { return stop_; })) return;
    }
    const double begin = thread_cpu_seconds();
    const Status shown = show_if_changed();
    if (!shown && shown.error().message != failed_) spdlog::info("page: {}", shown.error().message);
    failed_ = shown ? "" : shown.error().message;
    // Not by the clock: beside other work a reading takes many times as long, and the page would stand still.
    const double rest = std::min(kMaxPause, kPauseFactor * (thread_cpu_seconds() - begin));
    pause = std::max(kMinPause, std::chrono::milliseconds(std::llround(1e3 * rest)));
  }
}

Status LiveMonitor::show_if_changed() {
  // Before the files are read: what is written meanwhile is read the next time.
  std::string print = fingerprint(stores_());
  if (print == shown_ && !stale_) return {};
  auto run = read_();
  if (!run) {
    show_stale(run.error().message);
    return tl::unexpected(run.error());
  }
  shown_ = std::move(print);
  stale_ = false;
  {
    const std::lock_guard lock(mutex_);
    store_ = std::move(run->store);
  }
  if (view_ && view_->self == run->view.self) {
    if (const std::size_t lost = nodes_lost(*view_, run->view); lost > 0)
      replaced_ = "the store was replaced while it was shown: " + std::to_string(lost) +
                  " nodes of before are gone or have other points";
  }
  if (!replaced_.empty()) run->view.notes.push_back(replaced_);
  view_ = std::make_shared<const monitor::FleetView>(std::move(run->view));
  server_->publish(view_);
  return {};
}

void LiveMonitor::show_stale(const std::string& why) {
  if (!view_ || stale_) return;
  stale_ = true;
  monitor::FleetView before = *view_;
  before.notes.push_back("shown as it was read last, since it cannot be read now: " + why);
  server_->publish(std::make_shared<const monitor::FleetView>(std::move(before)));
}

Result<std::unique_ptr<LiveMonitor>> page_of_robot(const std::optional<monitor::ServerConfig>& config,
                                                   const fs::path& folder) {
  const fs::path file = folder / "store.db";
  return open_page(
      config, previews_of_store(file), [file] { return std::vector{file}; },
      [file] { return open_one(file); });
}

Result<std::unique_ptr<LiveMonitor>> page_of_run(const std::optional<monitor::ServerConfig>& config,
                                                 const fs::path& directory) {
  return open_page(
      config, previews_of_run(directory), [directory] { return robot_stores(directory); },
      [directory] { return open_run(directory, ""); });
}

}  // namespace fleetmap::apps
