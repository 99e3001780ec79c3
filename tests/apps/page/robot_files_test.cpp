#include "page/robot_files.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

TEST(RobotFiles, TheReportCountsUnlessTheStoreIsOfALaterRun) {
  const testing::TemporaryFolder folder;
  const RobotFiles files{*AgentId::parse("r1"), folder.path(), folder.path() / "store.db"};
  EXPECT_TRUE(report_of(files).is_null()) << "there is none";
  folder.write("store.db", "");
  folder.write("report.json", R"({"nodes": 7})");
  EXPECT_EQ(report_of(files)["nodes"], 7);
  const auto written = std::filesystem::last_write_time(folder.path() / "report.json");
  std::filesystem::last_write_time(files.store, written + std::chrono::minutes(9));
  EXPECT_EQ(report_of(files)["nodes"], 7) << "the store is closed after the report is written";
  std::filesystem::last_write_time(files.store, written + std::chrono::minutes(11));
  EXPECT_TRUE(report_of(files).is_null());
}

TEST(RobotFiles, AReportThatIsCutIsNone) {
  const testing::TemporaryFolder folder;
  folder.write("store.db", "");
  folder.write("report.json", R"({"nodes": )");
  EXPECT_TRUE(report_of({*AgentId::parse("r1"), folder.path(), folder.path() / "store.db"}).is_null());
}

}  // namespace
}  // namespace fleetmap::apps
