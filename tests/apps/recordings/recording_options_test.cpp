#include "recordings/recording_options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

namespace fleetmap::apps {
namespace {

using ::testing::ElementsAre;

TEST(RecordingOptions, OneRecordingAFileAndSettings) {
  CLI::App app;
  RecordingOptions options;
  add_recording_options(app, options);
  app.parse("-c r1.yaml --set a=1 --set b=2 drive");
  EXPECT_EQ(options.recording, "drive");
  EXPECT_EQ(options.config, "r1.yaml");
  EXPECT_THAT(options.set, ElementsAre("a=1", "b=2"));
  EXPECT_THROW(app.parse("-c r1.yaml"), CLI::ParseError);
  EXPECT_THROW(app.parse("drive other"), CLI::ParseError);
}

}  // namespace
}  // namespace fleetmap::apps
