// Pages of files that robots still write, or that are not there yet.
#include "apps/page/live_monitor.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <nlohmann/json.hpp>

#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/store/store.hpp"
#include "monitor/browser.hpp"
#include "store/items.hpp"
#include "support/command_line.hpp"
#include "support/eventually.hpp"
#include "support/process.hpp"

namespace fleetmap {
namespace {

using namespace std::chrono_literals;
using testing::agent;
using testing::eventually;

class LiveMonitor : public ::testing::Test {
 protected:
  void put_node(store::Store& store, std::uint32_t seq) const {
    const Bytes submap = testing::random_bytes(2000, seq);
    ASSERT_TRUE(store.put_node_with_submap(testing::make_node(agent("r1"), seq, submap, 5.0 * seq), submap));
  }
  static void put_node_with_points(store::Store& store) {
    cloud::PointCloud cloud;
    for (int k = 0; k < 500; ++k) cloud.points.emplace_back(0.1f * static_cast<float>(k), 1.0f, 0.0f);
    const Bytes submap = cloud::encode(cloud, {}).value();
    ASSERT_TRUE(store.put_node_with_submap(testing::make_node(agent("r1"), 0, submap, 0.0), submap));
  }
  static std::string answer(std::uint16_t port, const std::string& target) {
    testing::Browser browser(port);
    browser.get(target);
    return browser.answer();
  }
  static nlohmann::json state(std::uint16_t port) {
    const std::string said = answer(port, "/state.json");
    return nlohmann::json::parse(said.substr(said.find("\r\n\r\n") + 4), nullptr, false);
  }
  static std::size_t nodes_shown(std::uint16_t port) {
    const auto shown = state(port);
    return shown.is_object() && shown.contains("nodes") ? shown["nodes"].size() : 0;
  }
  static std::string notes_shown(std::uint16_t port) {
    return state(port).value("notes", nlohmann::json()).dump();
  }

  std::unique_ptr<store::Store> store_of(const std::string& name) const {
    const std::filesystem::path file = folder_ / name;
    std::filesystem::create_directories(file.parent_path());
    return std::make_unique<store::Store>(store::Store::open(file, agent("r1")).value());
  }

  testing::TemporaryFolder folder_;
};

TEST_F(LiveMonitor, shows_the_nodes_that_come_while_it_runs) {
  const auto store = store_of("store.db");
  put_node(*store, 0);
  testing::Process monitor(
      {testing::kProgram, "monitor", "--store", (folder_ / "store.db").string(), "--port", "0"});
  ASSERT_TRUE(eventually([&] { return testing::announced_port(monitor.output()) != 0; }, 60s))
      << monitor.output();
  const std::uint16_t port = testing::announced_port(monitor.output());
  EXPECT_EQ(nodes_shown(port), 1u);
  for (std::uint32_t seq = 1; seq <= 3; ++seq) {
    put_node(*store, seq);
    EXPECT_TRUE(eventually([&] { return nodes_shown(port) == seq + 1; }, 60s)) << seq;
  }
  monitor.signal(SIGTERM);
  EXPECT_EQ(monitor.wait(), 0) << monitor.output();
}

TEST_F(LiveMonitor, keeps_what_it_showed_when_the_store_is_taken_away) {
  put_node(*store_of("store.db"), 0);
  testing::Process monitor(
      {testing::kProgram, "monitor", "--store", (folder_ / "store.db").string(), "--port", "0"});
  ASSERT_TRUE(eventually([&] { return testing::announced_port(monitor.output()) != 0; }, 60s))
      << monitor.output();
  std::filesystem::remove(folder_ / "store.db");
  EXPECT_TRUE(eventually([&] { return monitor.output().find("page: ") != std::string::npos; }, 60s))
      << monitor.output();
  const std::uint16_t port = testing::announced_port(monitor.output());
  EXPECT_EQ(nodes_shown(port), 1u);
  const auto is_stale = [&] { return notes_shown(port).find("cannot be read now") != std::string::npos; };
  EXPECT_TRUE(eventually(is_stale, 60s)) << notes_shown(port);
  put_node(*store_of("store.db"), 0);
  EXPECT_TRUE(eventually([&] { return !is_stale(); }, 60s)) << notes_shown(port);
}

TEST_F(LiveMonitor, shows_a_store_of_any_name) {
  const auto store = store_of("merged.db");
  put_node(*store, 0);
  testing::Process monitor(
      {testing::kProgram, "monitor", "--store", (folder_ / "merged.db").string(), "--port", "0"});
  ASSERT_TRUE(eventually([&] { return testing::announced_port(monitor.output()) != 0; }, 60s))
      << monitor.output();
  const std::uint16_t port = testing::announced_port(monitor.output());
  EXPECT_EQ(nodes_shown(port), 1u);
  put_node(*store, 1);
  EXPECT_TRUE(eventually([&] { return nodes_shown(port) == 2; }, 60s));
}

TEST_F(LiveMonitor, keeps_first_points_beside_the_store_for_the_next_start) {
  const auto store = store_of("store.db");
  put_node_with_points(*store);
  const auto file = folder_ / "store.db.previews";
  testing::Process monitor(
      {testing::kProgram, "monitor", "--store", (folder_ / "store.db").string(), "--port", "0"});
  ASSERT_TRUE(eventually([&] { return std::filesystem::exists(file); }, 60s)) << monitor.output();
  monitor.signal(SIGTERM);
  EXPECT_EQ(monitor.wait(), 0) << monitor.output();
}

TEST_F(LiveMonitor, of_robots_that_still_drive_keeps_first_points_for_the_start_after_them) {
  monitor::ServerConfig any_port;
  any_port.port = 0;
  const auto store = store_of("out/r1/store.db");
  put_node_with_points(*store);
  const auto of_robot = apps::page_of_robot(any_port, folder_ / "out/r1");
  ASSERT_TRUE(of_robot) << of_robot.error().message;
  EXPECT_TRUE(eventually([&] { return std::filesystem::exists(folder_ / "out/r1/store.db.previews"); }, 60s));
  const auto of_run = apps::page_of_run(any_port, folder_ / "out");
  ASSERT_TRUE(of_run) << of_run.error().message;
  EXPECT_TRUE(eventually([&] { return std::filesystem::exists(folder_ / "out/monitor.previews"); }, 60s));
}

TEST_F(LiveMonitor, of_a_run_that_only_begins_shows_the_robots_that_come) {
  monitor::ServerConfig any_port;
  any_port.port = 0;
  const auto page = apps::page_of_run(any_port, folder_ / "out");
  ASSERT_TRUE(page) << page.error().message;
  const std::uint16_t port = (*page)->server().port();
  EXPECT_EQ(nodes_shown(port), 0u);
  const auto store = store_of("out/r1/store.db");
  EXPECT_EQ(nodes_shown(port), 0u);
  put_node(*store, 0);
  EXPECT_TRUE(eventually([&] { return nodes_shown(port) == 1; }, 60s));
}

TEST_F(LiveMonitor, shows_that_another_store_has_taken_its_place) {
  put_node(*store_of("store.db"), 0);
  std::atomic<bool> other = false;
  monitor::ServerConfig any_port;
  any_port.port = 0;
  const std::filesystem::path file = folder_ / "store.db", next = folder_ / "next.db";
  const auto page = apps::LiveMonitor::start(
      any_port, [&] { return std::vector{other ? next : file}; },
      [&] { return apps::open_one(other ? next : file); }, true);
  ASSERT_TRUE(page) << page.error().message;
  const std::uint16_t port = (*page)->server().port();
  const auto is_told = [&] { return notes_shown(port).find("was replaced") != std::string::npos; };
  EXPECT_TRUE(eventually([&] { return nodes_shown(port) == 1; }, 60s));
  EXPECT_FALSE(is_told());
  const auto second = store_of("next.db");
  const Bytes submap = testing::random_bytes(2000, 99);
  ASSERT_TRUE(second->put_node_with_submap(testing::make_node(agent("r1"), 0, submap), submap));
  other = true;
  EXPECT_TRUE(eventually(is_told, 60s)) << notes_shown(port);
  put_node(*second, 1);
  EXPECT_TRUE(eventually([&] { return nodes_shown(port) == 2; }, 60s));
  EXPECT_TRUE(is_told()) << "a viewer may have missed it";
}

// As for a moment after a store was replaced: the view is still of the one before.
TEST_F(LiveMonitor, points_of_another_content_are_never_named_by_the_hash_of_the_view) {
  put_node_with_points(*store_of("store.db"));
  monitor::ServerConfig any_port;
  any_port.port = 0;
  any_port.preview_file = folder_ / "previews";
  const std::filesystem::path file = folder_ / "store.db";
  const auto read = [&](bool before) {
    auto run = apps::open_one(file);
    if (run && before) run->view.nodes[0].submap_hash[0] ^= 1;
    return run;
  };
  for (const bool before : {true, false}) {
    const auto page = apps::LiveMonitor::start(
        any_port, [file] { return std::vector{file}; }, [&] { return read(before); }, true);
    ASSERT_TRUE(page) << page.error().message;
    const std::uint16_t port = (*page)->server().port();
    ASSERT_TRUE(eventually([&] { return nodes_shown(port) == 1; }, 60s));
    const std::string hash = state(port)["nodes"][0]["submap"];
    const std::string said = answer(port, "/submap/" + hash + "?from=0&count=10");
    EXPECT_EQ(said.find("FMP1") == std::string::npos, before) << said.substr(0, 200);
    EXPECT_EQ(said.find("the store was replaced") != std::string::npos, before) << said.substr(0, 200);
    const std::string first = answer(port, "/submaps?from=0&count=10&of=" + hash);
    constexpr std::size_t kEmpty = 32 + 36, kTenPoints = kEmpty + 10 * 8;
    EXPECT_EQ(first.size() - first.find("\r\n\r\n") - 4, before ? kEmpty : kTenPoints)
        << first.substr(0, 200);
    EXPECT_TRUE(!before || !std::filesystem::exists(any_port.preview_file));
  }
}

// The fingerprint of the files is the same before and after.
TEST_F(LiveMonitor, reads_again_what_could_not_be_read) {
  put_node(*store_of("store.db"), 0);
  std::atomic<bool> busy = true;
  monitor::ServerConfig any_port;
  any_port.port = 0;
  const std::filesystem::path file = folder_ / "store.db";
  const auto page = apps::LiveMonitor::start(
      any_port, [file] { return std::vector{file}; },
      [file, &busy]() -> Result<apps::LoadedRun> {
        if (busy) return failure("busy");
        return apps::open_one(file);
      },
      true);
  ASSERT_TRUE(page) << page.error().message;
  EXPECT_EQ(nodes_shown((*page)->server().port()), 0u);
  busy = false;
  EXPECT_TRUE(eventually([&] { return nodes_shown((*page)->server().port()) == 1; }, 60s));
}

}  // namespace
}  // namespace fleetmap
