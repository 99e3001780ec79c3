#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <utility>

#include "support/command_line.hpp"
#include "support/file_content.hpp"
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

/// Exit code and output of `inspect` for the first `size` bytes of a whole recording.
std::pair<int, std::string> inspection_of_beginning(std::size_t size) {
  const testing::TemporaryFolder folder;
  const std::string whole =
      testing::file_text(std::filesystem::path(FLEETMAP_SOURCE_DIR) / "tests/recording/data/no_chunks.mcap");
  const std::filesystem::path file = folder.path() / "drive.mcap";
  std::ofstream(file, std::ios::binary) << whole.substr(0, std::min(size, whole.size()));
  testing::Process process({testing::kProgram, "inspect", file.string()});
  const int code = process.wait();
  return {code, process.output()};
}

TEST(RecordingInspection, ACutIsAFinding) {
  constexpr const char* kFinding = "- 1 part of the recording is damaged or cut off";
  EXPECT_THAT(inspection_of_beginning(std::string::npos).second, ::testing::Not(HasSubstr(kFinding)));
  const std::size_t size = std::filesystem::file_size(std::filesystem::path(FLEETMAP_SOURCE_DIR) /
                                                      "tests/recording/data/no_chunks.mcap");
  const auto [cut_code, cut] = inspection_of_beginning(size * 3 / 4);
  EXPECT_EQ(cut_code, 1) << cut;
  EXPECT_THAT(cut, HasSubstr(kFinding));
}

TEST(RecordingInspection, ARecordingWithoutAScanIsAFinding) {
  constexpr std::size_t kBeforeTheFirstScan = 900;
  const auto [code, output] = inspection_of_beginning(kBeforeTheFirstScan);
  EXPECT_EQ(code, 1) << output;
  EXPECT_THAT(output, HasSubstr("- no scan: the LiDAR was off"));
}

}  // namespace
}  // namespace fleetmap
