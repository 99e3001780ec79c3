#include <gmock/gmock.h>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using ::testing::HasSubstr;

using FieldTrial = testing::CommandLineTest;

TEST_F(FieldTrial, ATrialIsReadAndListedWithoutRunningIt) {
  const std::string trial = FLEETMAP_SOURCE_DIR "/config/trials/links.yaml";
  run({"trial", trial, "--out", path("out"), "--list"});
  EXPECT_EQ(exit_code_, 0) << output_;
  EXPECT_THAT(output_, HasSubstr("--set field.radio.kbit_s=50"));
  run({"trial", trial, "--out", path("out"), "--list", "--field", path("none.sh")});
  EXPECT_EQ(exit_code_, 2) << output_;
  EXPECT_THAT(output_, HasSubstr("none.sh: does not exist"));
  run({"trial", trial, "--out", path("out"), "--set", "field.radio.loss=120"});
  EXPECT_EQ(exit_code_, 78) << output_;
  EXPECT_THAT(output_, HasSubstr("loss must be in [0, 100] %"));
  run({"trial", trial, "--out", path("out"), "--set", "field.qos=nowhere"});
  EXPECT_EQ(exit_code_, 78) << output_;
  EXPECT_THAT(output_, HasSubstr("nowhere does not exist"));
}

}  // namespace
}  // namespace fleetmap
