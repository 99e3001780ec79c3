#include "health/local_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::HasSubstr;

class LocalFiles : public ::testing::Test {
 protected:
  testing::TemporaryFolder folder_;
  agent::AgentConfig config_;
};

TEST_F(LocalFiles, AFolderThatIsThereOrCanBeMadeIsFine) {
  for (const char* name : {"", "out", "out/of/sight", "../out"}) {
    config_.directory = folder_.path() / name;
    EXPECT_TRUE(check_local_files(config_)) << name;
    EXPECT_EQ(write_warning(config_.directory), std::nullopt) << name;
  }
}

TEST_F(LocalFiles, AFolderBelowAFileCannotBeMade) {
  config_.directory = folder_.write("notes.txt", "") / "out";
  const Status checked = check_local_files(config_);
  ASSERT_FALSE(checked);
  EXPECT_THAT(checked.error().message, HasSubstr("notes.txt is no folder; give another one"));
}

TEST_F(LocalFiles, AFolderOfAnotherUserIsAWarning) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  EXPECT_THAT(write_warning("/fleetmap/out").value_or(""), HasSubstr("directory: / cannot be written to"));
}

TEST_F(LocalFiles, AGeoidWithoutItsDataIsRefused) {
  config_.directory = folder_.path();
  config_.perception.devices.geoid = "none-5";
  const Status checked = check_local_files(config_);
  ASSERT_FALSE(checked);
  EXPECT_THAT(checked.error().message, HasSubstr("gps.geoid: "));
}

}  // namespace
}  // namespace fleetmap::apps
