// A case's processes: their end, their use of the machine and their last words. The children are this test
// program, told to run one of the tests that are disabled otherwise.
#include "child_process.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "experiment/experiment_fixture.hpp"
#include "support/file_content.hpp"

namespace fleetmap::experiment {
namespace {

using ::testing::HasSubstr;

class ChildProcess : public ::testing::Test {
 protected:
  Result<ChildExit> run(const std::string& test, const std::atomic<bool>& stop) const {
    return run_self({"--gtest_also_run_disabled_tests", "--gtest_filter=Child.DISABLED_" + test}, log(),
                    stop);
  }
  std::filesystem::path log() const { return folder_.path() / "child.log"; }
  testing::TemporaryFolder folder_;
  std::atomic<bool> stop_{false};
};

TEST(Child, DISABLED_Ends) { std::puts("all is well"); }
TEST(Child, DISABLED_Fails) { FAIL() << "the farm has no rows"; }
TEST(Child, DISABLED_Crashes) { ::raise(SIGKILL); }
TEST(Child, DISABLED_Waits) {
  for (;;) ::pause();
}

TEST_F(ChildProcess, TellsHowItEnded) {
  const auto ended = run("Ends", stop_);
  ASSERT_TRUE(ended) << ended.error().message;
  EXPECT_EQ(ended->code, 0);
  EXPECT_FALSE(ended->signalled);
  EXPECT_GT(ended->peak_megabytes, 0.5);
  EXPECT_THAT(testing::file_text(log()), HasSubstr("all is well"));

  const auto failed = run("Fails", stop_);
  ASSERT_TRUE(failed);
  EXPECT_EQ(failed->code, 1);
  EXPECT_THAT(tail_of(log(), 20), HasSubstr("the farm has no rows"));

  const auto crashed = run("Crashes", stop_);
  ASSERT_TRUE(crashed);
  EXPECT_TRUE(crashed->signalled);
  EXPECT_EQ(crashed->code, 128 + SIGKILL);
}

TEST_F(ChildProcess, EndsWhenTheExperimentIsStopped) {
  stop_ = true;
  const auto ended = run("Waits", stop_);
  ASSERT_TRUE(ended) << ended.error().message;
  EXPECT_TRUE(ended->signalled);
}

TEST_F(ChildProcess, TailIsTheLastLines) {
  const auto file = folder_.write("log", "one\ntwo\nthree\n");
  EXPECT_EQ(tail_of(file, 2), "two\nthree");
  EXPECT_EQ(tail_of(folder_.path() / "none", 2), "");
}

}  // namespace
}  // namespace fleetmap::experiment
