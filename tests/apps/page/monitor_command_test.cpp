#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "support/command_line.hpp"
#include "support/eventually.hpp"

namespace fleetmap {
namespace {

using MonitorCommand = testing::CommandLineTest;

TEST_F(MonitorCommand, RefusesWhatItCannotTake) {
  expect_usage_error({"monitor", "--store", ""}, "--store: is empty; give a path");
  expect_usage_error({"monitor", "--run", ""}, "--run: is empty; give a path");
  expect_usage_error({"monitor", "--run", "r", "--port", "65536"},
                     "--port: must be a whole number from 0 to 65535");
}

TEST_F(MonitorCommand, RefusesFilesThatAreNotThere) {
  const auto expect_failure = [](std::vector<std::string> arguments, const std::string& reason) {
    arguments.insert(arguments.begin(), testing::kProgram);
    testing::Process monitor(arguments);
    ASSERT_TRUE(testing::eventually([&] { return !monitor.running(); }, std::chrono::seconds(60)))
        << "it serves a page: " << monitor.output();
    EXPECT_EQ(monitor.wait(), 1) << reason;
    EXPECT_EQ(monitor.output(), reason + '\n');
  };
  expect_failure({"monitor", "--store", path("none.db"), "--port", "0"},
                 path("none.db") + ": no such file; give the store.db of a robot");
  expect_failure({"monitor", "--run", path("none"), "--port", "0"},
                 path("none") + ": no such folder; give the --out of a run");
  std::filesystem::create_directories(path("empty/r1"));
  expect_failure({"monitor", "--run", path("empty"), "--port", "0"},
                 path("empty") + ": holds no robot's store.db; give the --out of a run");
}

}  // namespace
}  // namespace fleetmap
