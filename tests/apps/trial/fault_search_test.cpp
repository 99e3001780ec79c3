#include "trial/fault_search.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <memory>
#include <sstream>

#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;

FuzzOptions one_small_fleet() {
  FuzzOptions options;
  options.seeds = 1;
  options.robots = {2};
  options.mapping = 20.0;
  options.jobs = 1;
  return options;
}

TEST(FaultSearch, CountsTheSeedsThatFail) {
  std::ostringstream out;
  const auto ended = search_faults(one_small_fleet(), out);
  ASSERT_TRUE(ended);
  EXPECT_EQ(*ended, kDone) << out.str();
  EXPECT_THAT(out.str(), ContainsRegex("1 seeds, 0 failed; [1-9][0-9]* nodes, [1-9][0-9]* packets"));
}

/// The robots log the faults that are injected; the log of the program that called it goes on afterwards.
TEST(FaultSearch, SilencesTheLogWhileItRunsAlone) {
  const auto lines = std::make_shared<std::ostringstream>();
  const auto sink = std::make_shared<spdlog::sinks::ostream_sink_mt>(*lines);
  const auto level = spdlog::get_level();
  spdlog::default_logger()->sinks().push_back(sink);
  spdlog::set_level(spdlog::level::debug);
  std::ostringstream out;
  const auto ended = search_faults(one_small_fleet(), out);
  const auto after = spdlog::get_level();
  spdlog::set_level(level);
  spdlog::default_logger()->sinks().pop_back();
  ASSERT_TRUE(ended);
  EXPECT_EQ(lines->str(), "");
  EXPECT_EQ(after, spdlog::level::debug);
}

TEST(FaultSearch, AReplayPrintsTheSameFleetEachTimeAndLeavesItsStores) {
  const testing::TemporaryFolder folder;
  FuzzOptions options = one_small_fleet();
  options.replay = 7;
  options.faults = "loss";  // others name the folder of the stores
  std::ostringstream first, second;
  ASSERT_TRUE(search_faults(options, first));
  options.stores = (folder.path() / "stores").string();
  ASSERT_TRUE(search_faults(options, second));
  EXPECT_EQ(first.str(), second.str());
  EXPECT_THAT(first.str(), HasSubstr("2 robots, "));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "stores/r1.db"));
}

TEST(FaultSearch, KindsThatAreNoneAreRefused) {
  std::ostringstream out;
  FuzzOptions options = one_small_fleet();
  options.faults = "meteor";
  const auto faults = search_faults(options, out);
  ASSERT_FALSE(faults);
  EXPECT_EQ(faults.error().code, kUsage);
  EXPECT_THAT(faults.error().error.message, HasSubstr("meteor"));
  options = one_small_fleet();
  options.invariants = "beauty";
  const auto invariants = search_faults(options, out);
  ASSERT_FALSE(invariants);
  EXPECT_EQ(invariants.error().code, kUsage);
  EXPECT_THAT(invariants.error().error.message, HasSubstr("beauty"));
}

}  // namespace
}  // namespace fleetmap::apps
