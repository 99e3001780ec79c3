// Measures the time that a robot takes for a scan while nobody and while ten viewers look at its page, in
// turns, so that both see the same machine. Each viewer reads every state and status, and fetches the newest
// submap.
//   bench_monitor_viewers [PAIRS]    of blocks of kBlock scans; 20
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "agent/lapping_robot.hpp"
#include "fleetmap/core/cpu_time.hpp"
#include "monitor/browser.hpp"
#include "page/live_monitor.hpp"
#include "page/live_publisher.hpp"
#include "store/items.hpp"

namespace {

using namespace fleetmap;
using testing::Browser;
using testing::LappingRobot;

constexpr std::size_t kViewers = 10;
constexpr int kBlock = 100;  // scans
constexpr double kScanRate = 10.0;

/// A page that is open, on a thread of its own.
class OpenPage {
 public:
  explicit OpenPage(std::uint16_t port) : browser_(port), port_(port) {
    browser_.upgrade();
    browser_.answer();
    thread_ = std::thread([this] { follow(); });
  }
  ~OpenPage() {
    stop_ = true;
    thread_.join();
  }
  static inline std::atomic<std::uint64_t> statuses{0}, states{0}, submaps{0};

 private:
  void follow() {
    while (!stop_) {
      const auto message = nlohmann::json::parse(browser_.message(), nullptr, false);
      if (message.is_discarded()) return;
      if (message.contains("live")) ++statuses;
      if (!message.contains("nodes") || message["nodes"].empty()) continue;
      ++states;
      const auto& last = message["nodes"].back();
      if (!last.contains("submap")) continue;
      Browser fetch(port_);
      fetch.get("/submap/" + last["submap"].get<std::string>() + "?from=0&count=4096");
      submaps += fetch.status() == "200";
    }
  }

  Browser browser_;
  std::uint16_t port_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

double quantile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

struct Robot {
  explicit Robot(const std::filesystem::path& folder)
      : robot({.scan_rate = kScanRate, .columns = 900, .folder = folder}) {
    monitor::ServerConfig config;
    config.max_viewers = kViewers;
    page = apps::LiveMonitor::start(
               config, [store = folder / "store.db"] { return std::vector{store}; },
               [store = folder / "store.db"] { return apps::open_one(store); }, true)
               .value();
    publisher.emplace(robot.agent(), robot.bus(), page->server(), "nobody",
                      [](const auto&) { return false; });
  }
  /// ms a scan: by the clock, one for each second of virtual time, and the CPU of this thread.
  struct Times {
    std::vector<double> wall;
    double cpu = 0.0;
  };
  /// Returns the median of the block.
  double run_block(Times& times) {
    const std::size_t first = times.wall.size();
    const double cpu = thread_cpu_seconds();
    for (int second = 0; second < kBlock / static_cast<int>(kScanRate); ++second) {
      const auto begun = std::chrono::steady_clock::now();
      robot.run_for(1.0);
      publisher->publish({}, {});
      const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begun;
      times.wall.push_back(taken.count() / kScanRate);
    }
    times.cpu += 1e3 * (thread_cpu_seconds() - cpu) / kBlock;
    return quantile({times.wall.begin() + static_cast<std::ptrdiff_t>(first), times.wall.end()}, 0.5);
  }

  LappingRobot robot;
  std::unique_ptr<apps::LiveMonitor> page;
  std::optional<apps::LivePublisher> publisher;
};

void print(const char* name, const Robot::Times& times, int pairs) {
  std::printf("| %s | %.2f | %.2f | %.2f |\n", name, quantile(times.wall, 0.5), quantile(times.wall, 0.99),
              times.cpu / pairs);
}

int measure(int pairs) {
  const testing::TemporaryFolder folder;
  Robot robot(folder / "r1");
  Robot::Times warm_up, alone, watched;
  std::vector<double> ratios;  // of the medians of a pair of blocks
  for (int block = 0; block < 4; ++block) robot.run_block(warm_up);
  for (int pair = 0; pair < pairs; ++pair) {
    const double before = robot.run_block(alone);
    std::vector<std::unique_ptr<OpenPage>> pages;
    for (std::size_t k = 0; k < kViewers; ++k)
      pages.push_back(std::make_unique<OpenPage>(robot.page->server().port()));
    while (robot.page->server().stats().viewers < kViewers) std::this_thread::yield();
    ratios.push_back(robot.run_block(watched) / before);
    // Each page ends with the next status that it reads.
    std::thread closing([&] { pages.clear(); });
    while (robot.page->server().stats().viewers > 0) robot.publisher->publish({}, {});
    closing.join();
  }
  std::printf("| viewers | ms a scan, p50 | p99 | CPU ms of the robot's thread |\n|---|---|---|---|\n");
  print("0", alone, pairs);
  print("10", watched, pairs);
  std::printf("ratio: p50 %.3f, p99 %.3f, CPU %.3f; of the pairs' medians, quartiles: %.3f, %.3f, %.3f\n",
              quantile(watched.wall, 0.5) / quantile(alone.wall, 0.5),
              quantile(watched.wall, 0.99) / quantile(alone.wall, 0.99), watched.cpu / alone.cpu,
              quantile(ratios, 0.25), quantile(ratios, 0.5), quantile(ratios, 0.75));
  std::printf("the viewers read %lu statuses, %lu states and %lu submaps\n", OpenPage::statuses.load(),
              OpenPage::states.load(), OpenPage::submaps.load());
  const bool all_read = OpenPage::statuses > 0 && OpenPage::states > 0 && OpenPage::submaps > 0;
  return all_read ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

int main(int argc, char** argv) { return measure(argc > 1 ? std::atoi(argv[1]) : 20); }
