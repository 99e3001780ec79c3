#include "fleetmap/agent/store_failures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "bus/captured_log.hpp"

namespace fleetmap::agent {
namespace {

using namespace std::chrono_literals;
using bus::testing::CapturedLog;
using ::testing::HasSubstr;

TEST(StoreFailures, LogsTheFirstFailureAndWhenTheStoreWorksAgain) {
  StoreFailures failures("r1", "out/store.db");
  {
    const CapturedLog log;
    for (int k = 0; k < 5; ++k) failures.on_failure({"the disk is full"}, 7, Stamp{} + k * 1s);
    EXPECT_EQ(log.count("r1: the disk is full"), 1);
  }
  EXPECT_EQ(failures.total(), 5u);
  const CapturedLog log;
  failures.check(7);
  EXPECT_EQ(log.text(), "") << "nothing was added since the failure";
  failures.check(8);
  EXPECT_THAT(log.text(), HasSubstr("out/store.db works again; 5 writes were refused"));
}

TEST(StoreFailures, AStoreThatNeverFailedIsNotLogged) {
  StoreFailures failures("r1", "out/store.db");
  const CapturedLog log;
  failures.check(0);
  failures.check(1);
  EXPECT_EQ(log.text(), "");
}

}  // namespace
}  // namespace fleetmap::agent
