// Failures of commands that read a recording.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "support/command_line.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap {
namespace {

using ::testing::HasSubstr;

TEST(RecordingInput, FailsWithTheCodeOfWhatIsWrong) {
  const testing::TemporaryFolder folder;
  const std::string file = (folder.path() / "bad.yaml").string();
  std::ofstream(file) << "lidar: {model: fish}\n";
  const auto exit_code = [](std::vector<std::string> arguments, const char* named) {
    arguments.insert(arguments.begin(), {testing::kProgram, "inspect"});
    testing::Process process(arguments);
    const int code = process.wait();
    EXPECT_THAT(process.output(), HasSubstr(named));
    return code;
  };
  EXPECT_EQ(exit_code({"nowhere"}, "nowhere"), 1);
  EXPECT_EQ(exit_code({"nowhere", "--set", "lidar.model"}, "lidar.model"), 2);
  EXPECT_EQ(exit_code({"nowhere", "-c", file}, "bad.yaml:1"), 78);
}

}  // namespace
}  // namespace fleetmap
