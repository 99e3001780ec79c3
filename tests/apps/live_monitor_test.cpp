// `fleetmap monitor` beside a robot that still writes its store.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

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
  static std::size_t nodes_shown(std::uint16_t port) {
    testing::Browser browser(port);
    browser.get("/state.json");
    const std::string answer = browser.answer();
    const auto state = nlohmann::json::parse(answer.substr(answer.find("\r\n\r\n") + 4), nullptr, false);
    return state.is_object() && state.contains("nodes") ? state["nodes"].size() : 0;
  }

  testing::TemporaryFolder folder_;
};

TEST_F(LiveMonitor, shows_the_nodes_that_come_while_it_runs) {
  auto store = store::Store::open(folder_ / "store.db", agent("r1")).value();
  put_node(store, 0);
  testing::Process monitor(
      {testing::kProgram, "monitor", "--store", (folder_ / "store.db").string(), "--port", "0"});
  ASSERT_TRUE(eventually([&] { return testing::announced_port(monitor.output()) != 0; }, 60s))
      << monitor.output();
  const std::uint16_t port = testing::announced_port(monitor.output());
  EXPECT_EQ(nodes_shown(port), 1u);
  for (std::uint32_t seq = 1; seq <= 3; ++seq) {
    put_node(store, seq);
    EXPECT_TRUE(eventually([&] { return nodes_shown(port) == seq + 1; }, 60s)) << seq;
  }
  monitor.signal(SIGTERM);
  EXPECT_EQ(monitor.wait(), 0) << monitor.output();
}

TEST_F(LiveMonitor, keeps_what_it_showed_when_the_store_is_taken_away) {
  put_node(*std::make_unique<store::Store>(store::Store::open(folder_ / "store.db", agent("r1")).value()), 0);
  testing::Process monitor(
      {testing::kProgram, "monitor", "--store", (folder_ / "store.db").string(), "--port", "0"});
  ASSERT_TRUE(eventually([&] { return testing::announced_port(monitor.output()) != 0; }, 60s))
      << monitor.output();
  std::filesystem::remove(folder_ / "store.db");
  EXPECT_TRUE(eventually([&] { return monitor.output().find("page: ") != std::string::npos; }, 60s))
      << monitor.output();
  EXPECT_EQ(nodes_shown(testing::announced_port(monitor.output())), 1u);
}

}  // namespace
}  // namespace fleetmap
