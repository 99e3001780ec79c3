// `fleetmap monitor`: which stores its page is of, and how it ends. Its content: tests/monitor.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>

#include "fleetmap/store/store.hpp"
#include "monitor/browser.hpp"
#include "store/items.hpp"
#include "support/command_line.hpp"
#include "support/eventually.hpp"

namespace fleetmap {
namespace {

using PageService = testing::CommandLineTest;

TEST_F(PageService, IsOfOneStoreOrOfOneRun) {
  expect_usage_error({"monitor"}, "give either --store FILE or --run DIR");
  expect_usage_error({"monitor", "--store", "s.db", "--run", "out"}, "give either --store FILE or --run DIR");
  expect_usage_error({"monitor", "--run", "out", "--without", "R 1"}, "agent id 'R 1' must be");
}

TEST_F(PageService, ShowsARunUntilASignal) {
  std::filesystem::create_directories(folder_ / "run/r1");
  {
    auto store = store::Store::open(folder_ / "run/r1/store.db", testing::agent("r1")).value();
    const Bytes submap = testing::random_bytes(2000, 1);
    ASSERT_TRUE(store.put_node_with_submap(testing::make_node(testing::agent("r1"), 0, submap, 5.0), submap));
  }
  testing::Process monitor({testing::kProgram, "monitor", "--run", path("run"), "--port", "0"});
  ASSERT_TRUE(testing::eventually([&] { return testing::announced_port(monitor.output()) != 0; },
                                  std::chrono::seconds(60)))
      << monitor.output();
  testing::Browser browser(testing::announced_port(monitor.output()));
  browser.get("/state.json");
  EXPECT_NE(browser.answer().find("\"nodes\""), std::string::npos);
  monitor.signal(SIGTERM);
  EXPECT_EQ(monitor.wait(), 0) << monitor.output();
}

}  // namespace
}  // namespace fleetmap
