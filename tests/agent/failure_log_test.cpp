#include "fleetmap/agent/failure_log.hpp"

#include <gtest/gtest.h>

namespace fleetmap::agent {
namespace {

using namespace std::chrono_literals;

TEST(FailureLog, ReportsTheFirstFailureAndHowManyThereWereWhenItWorksAgain) {
  FailureLog log(30s);
  const Stamp start{};
  EXPECT_EQ(log.on_success(), 0u);
  EXPECT_TRUE(log.on_failure(start));
  for (int k = 1; k < 1000; ++k) EXPECT_FALSE(log.on_failure(start + k * 1s)) << "said once, however long";
  EXPECT_TRUE(log.failing());
  EXPECT_EQ(log.on_success(), 1000u);
  EXPECT_FALSE(log.failing());
  EXPECT_EQ(log.on_success(), 0u) << "said already";
  EXPECT_TRUE(log.on_failure(start + 1000s));
  EXPECT_EQ(log.total(), 1001u);
}

TEST(FailureLog, OneThatFailsNowAndThenIsNotReportedEachTime) {
  FailureLog log(30s);
  int lines = 0;
  for (int k = 0; k < 90; ++k) {
    lines += log.on_failure(Stamp{} + k * 1s) ? 1 : 0;
    log.on_success();
  }
  EXPECT_EQ(lines, 3);
  EXPECT_EQ(log.total(), 90u);
}

}  // namespace
}  // namespace fleetmap::agent
