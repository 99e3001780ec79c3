#include "command_result.hpp"

#include <gtest/gtest.h>

namespace fleetmap::apps {
namespace {

TEST(CommandResult, AnErrorGoesToStandardErrorAndItsCodeToTheShell) {
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(report(exit_with(kBadConfiguration, {"r1.yaml:4: unknown key"})), 78);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "r1.yaml:4: unknown key\n");
}

TEST(CommandResult, WithoutAnErrorNothingIsPrinted) {
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(report(kDone), 0);
  EXPECT_EQ(report(kFailed), 1);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace fleetmap::apps
