#include <gmock/gmock.h>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using ::testing::HasSubstr;

using DoctorCommand = testing::CommandLineTest;

TEST_F(DoctorCommand, RefusesWhatItCannotTake) {
  expect_usage_error({"doctor"}, "--config is required");
  expect_usage_error({"doctor", "-c", "r1.yaml", "--seconds", "0"}, "--seconds: ");
}

TEST_F(DoctorCommand, AFileThatIsNoneExitsWith78) {
  run({"doctor", "-c", path("none.yaml"), "--seconds", "1"});
  EXPECT_EQ(exit_code_, 78);
  EXPECT_THAT(output_, HasSubstr("none.yaml: no such file"));
}

}  // namespace
}  // namespace fleetmap
