#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/command_line.hpp"
#include "support/generated_fleet.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;

TEST(RecordingInspection, ListsTheSensorsOfASoundRecording) {
  const testing::TemporaryFolder folder;
  ASSERT_TRUE(testing::write_generated_fleet(folder.path() / "bags", {"r2"}));
  testing::Process r1({testing::kProgram, "inspect", (folder.path() / "bags/r1").string()});
  EXPECT_EQ(r1.wait(), 0) << r1.output();
  EXPECT_THAT(r1.output(), ContainsRegex("LiDAR +[0-9]+ +[0-9.]+ s +(9\\.9|10\\.[0-2]) Hz"));
  EXPECT_THAT(r1.output(), ContainsRegex("GPS +[1-9]"));
  EXPECT_THAT(r1.output(), HasSubstr("nothing found"));
  testing::Process r2({testing::kProgram, "inspect", (folder.path() / "bags/r2").string()});
  EXPECT_EQ(r2.wait(), 0) << r2.output();
  EXPECT_THAT(r2.output(), ContainsRegex("GPS +0 +none"));
}

}  // namespace
}  // namespace fleetmap
