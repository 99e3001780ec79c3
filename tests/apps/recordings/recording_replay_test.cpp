#include "recordings/recording_replay.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::HasSubstr;

class RecordingReplayTest : public ::testing::Test {
 protected:
  std::string file() const {
    return folder_
        .write("r7.yaml",
               "id: r7\nfleet: [r7, r8]\ndirectory: out\nrecording: {path: drive}\ndds:\n  onboard: {domain: "
               "41}\n")
        .string();
  }
  static ReplayOptions options_of(const std::string& recording, const std::string& config,
                                  const std::string& as) {
    ReplayOptions options;
    options.recording = recording;
    options.config = config;
    options.as = as;
    return options;
  }
  testing::TemporaryFolder folder_;
};

TEST_F(RecordingReplayTest, StandsForTheSensorsOfTheFilesRobot) {
  const auto replay = replay_of(options_of("", file(), ""));
  ASSERT_TRUE(replay) << replay.error().error.message;
  EXPECT_EQ(replay->robot.dds.agent.str(), "r7");
  EXPECT_EQ(replay->robot.dds.onboard.domain, 41u);
  EXPECT_TRUE(replay->robot.dds.onboard.enabled);
  EXPECT_FALSE(replay->robot.dds.long_range.enabled || replay->robot.dds.short_range.enabled)
      << "sensors have no business on the radios";
  EXPECT_EQ(replay->recording.filename(), "drive");
}

TEST_F(RecordingReplayTest, TheCommandLineNamesAnotherRecordingAndAnotherRobot) {
  const auto replay = replay_of(options_of("bag", file(), "r8"));
  ASSERT_TRUE(replay) << replay.error().error.message;
  EXPECT_EQ(replay->recording, "bag");
  EXPECT_EQ(replay->robot.dds.agent.str(), "r8");
  const auto wrong = replay_of(options_of("bag", "", "R 8"));
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().code, kBadConfiguration);
  EXPECT_THAT(wrong.error().error.message, HasSubstr("--as: "));
}

TEST_F(RecordingReplayTest, TopicsThatNobodyReadsAreNamedApartFromAMissingAgent) {
  config::RobotConfig robot;
  robot.dds.onboard.domain = 41;
  robot.agent.perception.topics.imu = "rt/imu/data";
  EXPECT_TRUE(check_readers(robot, {1, 1, 1, 1}));
  const Status nobody = check_readers(robot, {0, 0, 0, 0});
  ASSERT_FALSE(nobody);
  EXPECT_THAT(nobody.error().message, HasSubstr("no agent listens on onboard domain 41; start the agent"));
  const Status other_name = check_readers(robot, {1, 0, 1, 1});
  ASSERT_FALSE(other_name);
  EXPECT_THAT(
      other_name.error().message,
      HasSubstr("an agent on onboard domain 41 reads /points, /fix, /wheel_odometry, but nobody reads"));
  EXPECT_THAT(other_name.error().message,
              HasSubstr("nobody reads /imu/data (topics.imu); the agent has another name for it"));
  const Status no_fixes = check_readers(robot, {1, 1, 0, 1});
  ASSERT_FALSE(no_fixes);
  EXPECT_THAT(no_fixes.error().message,
              HasSubstr("nobody reads /fix (topics.fix); the agent has gps.use: false or"));
  robot.agent.perception.uses_gps = false;
  EXPECT_TRUE(check_readers(robot, {1, 1, 0, 1}));
}

TEST_F(RecordingReplayTest, WithoutARecordingItFails) {
  const auto none = replay_of({});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, kUsage);
  EXPECT_THAT(none.error().error.message, HasSubstr("name a recording"));
  std::ostringstream out;
  const auto missing = replay_recording(options_of((folder_.path() / "none").string(), "", ""), out);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, kFailed);
  EXPECT_THAT(missing.error().error.message, HasSubstr((folder_.path() / "none").string()));
}

}  // namespace
}  // namespace fleetmap::apps
