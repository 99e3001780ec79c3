#include "fleetmap/bus/stall_detector.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fleetmap::bus {
namespace {

using namespace std::chrono_literals;

/// A thread whose time is told, looked at every 0.5 s.
class WatchedThread : public ::testing::Test {
 protected:
  static constexpr SteadyTime kStart{1000s};

  void begin(const char* name) { activity_.under_way = WorkUnderWay{++number_, name, now_}; }
  void end() {
    activity_.ended.push_back({*activity_.under_way, now_});
    activity_.under_way.reset();
  }
  /// Lets time pass, with looks.
  void pass(Duration time) {
    for (const SteadyTime until = now_ + time; now_ < until;) {
      now_ += std::min<Duration>(500ms, until - now_);
      check();
    }
  }
  /// Lets time pass in which nobody looks.
  void skip(Duration time) { now_ += time; }
  void check() {
    for (const StallNews& stall : detector_.check(now_, activity_)) news_.push_back(stall);
    activity_.ended.clear();
  }

  StallDetector detector_{"callback thread", 2s};
  SteadyTime now_ = kStart;
  std::uint64_t number_ = 0;
  ThreadActivity activity_;
  std::vector<StallNews> news_;
};

TEST_F(WatchedThread, IsReportedOnceWhileStuckAndOnceWhenItGoesOn) {
  begin("topic rt/points");
  pass(1900ms);
  EXPECT_TRUE(news_.empty());
  pass(200ms);
  ASSERT_EQ(news_.size(), 1u);
  EXPECT_EQ(news_[0].text, "callback thread stuck for 2.1 s in topic rt/points");
  EXPECT_FALSE(news_[0].goes_on);
  pass(3200ms);
  EXPECT_EQ(news_.size(), 1u) << "it is the same stall";
  EXPECT_EQ(detector_.counters().longest, 5300ms) << "a report that is written meanwhile tells of it";
  end();
  pass(500ms);
  ASSERT_EQ(news_.size(), 2u);
  EXPECT_EQ(news_[1].text, "callback thread goes on after 5.3 s in topic rt/points");
  EXPECT_TRUE(news_[1].goes_on);
  EXPECT_EQ(detector_.counters().times, 1u);
  EXPECT_EQ(detector_.counters().longest_work, "topic rt/points");
}

TEST_F(WatchedThread, EachStallIsCounted) {
  begin("topic rt/points");
  pass(6s);
  end();
  begin("timer exchange");
  pass(3s);
  end();
  pass(500ms);
  EXPECT_EQ(news_.size(), 2u) << "of the second one a line comes within the minute";
  pass(1min);
  ASSERT_EQ(news_.size(), 3u);
  EXPECT_THAT(news_[2].text, ::testing::HasSubstr("was stuck once more in"));
  EXPECT_THAT(news_[2].text, ::testing::EndsWith("for 3.0 s in timer exchange"));
  EXPECT_EQ(detector_.counters().times, 2u);
  EXPECT_EQ(detector_.counters().longest, 6s);
  EXPECT_EQ(detector_.counters().longest_work, "topic rt/points");
}

TEST_F(WatchedThread, ManyStallsAreOneLineAMinuteWithTheirCount) {
  for (int k = 0; k < 100; ++k) {
    begin("topic rt/points");
    pass(k == 70 ? 4s : 2500ms);
    end();
    pass(500ms);
  }
  // 100 in 301.5 s: the first one twice, then five minutes.
  ASSERT_LE(news_.size(), 7u);
  ASSERT_GE(news_.size(), 6u);
  EXPECT_EQ(news_[0].text, "callback thread stuck for 2.0 s in topic rt/points");
  EXPECT_EQ(news_[1].text, "callback thread goes on after 2.5 s in topic rt/points");
  EXPECT_THAT(news_[2].text,
              ::testing::MatchesRegex("callback thread was stuck (19|20) times more in 6[0-3] s, for up to "
                                      "2.5 s in topic rt/points"));
  EXPECT_FALSE(news_[2].goes_on);
  EXPECT_THAT(news_[5].text, ::testing::HasSubstr("for up to 4.0 s"));
  EXPECT_EQ(detector_.counters().times, 100u);
  news_.clear();
  pass(3min);
  EXPECT_LE(news_.size(), 1u) << "what was left to count";
  news_.clear();
  begin("timer exchange");
  pass(3s);
  ASSERT_EQ(news_.size(), 1u) << "after a quiet minute it is told at once";
  EXPECT_EQ(news_[0].text, "callback thread stuck for 2.0 s in timer exchange");
}

TEST_F(WatchedThread, AStallThatEndsBetweenTwoLooksIsReportedAsAnError) {
  begin("timer status");
  pass(1800ms);
  skip(300ms);
  end();
  check();
  ASSERT_EQ(news_.size(), 1u);
  EXPECT_EQ(news_[0].text, "callback thread was stuck for 2.1 s in timer status");
  EXPECT_FALSE(news_[0].goes_on);
  EXPECT_EQ(detector_.counters().times, 1u);
}

TEST_F(WatchedThread, ManyShortCallbacksAreNoStall) {
  for (int k = 0; k < 20; ++k) {
    begin("topic rt/imu");
    pass(1500ms);
    end();
  }
  pass(500ms);
  EXPECT_TRUE(news_.empty());
  EXPECT_EQ(detector_.counters().times, 0u);
}

TEST_F(WatchedThread, TheTimeInWhichTheProcessStoodStillIsNotTheWorks) {
  begin("topic rt/points");
  pass(1s);
  skip(30s);
  pass(500ms);
  EXPECT_TRUE(news_.empty()) << news_[0].text;
  pass(1s);
  ASSERT_EQ(news_.size(), 1u) << "1 s before the pause and 1 s after it";
  EXPECT_EQ(news_[0].text, "callback thread stuck for 2.0 s in topic rt/points");
  end();
  // A stop of the process during one piece of work does not excuse the next.
  pass(2min);
  begin("timer exchange");
  pass(2s);
  ASSERT_EQ(news_.size(), 3u);
  EXPECT_EQ(news_[2].text, "callback thread stuck for 2.0 s in timer exchange");
}

}  // namespace
}  // namespace fleetmap::bus
