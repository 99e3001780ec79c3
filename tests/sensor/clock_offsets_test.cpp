#include "fleetmap/sensor/clock_offsets.hpp"

#include <gtest/gtest.h>

#include <random>

namespace fleetmap::sensor {
namespace {

/// A robot whose sensors have stamps that may be off, and drivers that take their time.
class Robot {
 public:
  explicit Robot(std::uint32_t seed) : random_(seed) {}

  double off[kSources] = {};    ///< s, added to stamps
  double drift[kSources] = {};  ///< s a second
  bool there[kSources] = {true, true, true, true};

  /// Lets `seconds` pass; `stall` of them the program stands still and then finds all that came.
  void run(double seconds, double stall = 0.0) {
    constexpr double kPeriod[kSources] = {0.1, 0.01, 1.0, 0.05}, kDriver[kSources] = {0.11, 0.002, 0.2, 0.01};
    const double end = time_ + seconds, awake = time_ + stall;
    for (; time_ < end; time_ += 0.01) {
      for (std::size_t k = 0; k < kSources; ++k) {
        if (!there[k] || time_ < next_[k]) continue;
        next_[k] += kPeriod[k];
        const double late = kDriver[k] * (1.0 + std::exponential_distribution<double>(2.0)(random_));
        const double stamp = time_ + off[k] + drift[k] * time_;
        offsets.add(static_cast<Source>(k), at(stamp), at(std::max(time_ + late, awake)));
        unclear[k] += robot_unclear(k);
        const double corrected = stamp + to_seconds(offsets.correction(static_cast<Source>(k)));
        worst[k] = std::max(worst[k], std::abs(corrected - time_));
      }
    }
    for (std::string& text : offsets.take_news()) news.push_back(std::move(text));
  }
  ClockOffsets offsets;
  double worst[kSources] = {};  ///< s, error of a corrected stamp
  int unclear[kSources] = {};   ///< samples
  std::vector<std::string> news;

 private:
  bool robot_unclear(std::size_t k) const { return offsets.unclear(static_cast<Source>(k)); }
  static Stamp at(double seconds) { return stamp_from_ns(1'700'000'000'000'000'000) + from_seconds(seconds); }
  std::mt19937 random_;
  double time_ = 0.0;
  double next_[kSources] = {};
};

constexpr auto kLidar = static_cast<std::size_t>(Source::kLidar);
constexpr auto kImu = static_cast<std::size_t>(Source::kImu);
constexpr auto kGps = static_cast<std::size_t>(Source::kGps);

TEST(ClockOffsets, LeavesSensorsOfOneClockAlone) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    Robot robot(seed);
    robot.run(60.0);
    EXPECT_TRUE(robot.news.empty()) << robot.news.front();
    for (const double error : robot.worst) EXPECT_LT(error, 1e-9);
    for (const int samples : robot.unclear) EXPECT_EQ(samples, 0);
  }
}

TEST(ClockOffsets, CorrectsTheOneThatIsOffAndSaysSoOnce) {
  for (const double off : {-2.0, 2.0, -18.0, 37.0, -1.6e9}) {
    Robot robot(1);
    robot.off[kLidar] = off;
    robot.run(6.0);
    ASSERT_EQ(robot.news.size(), 1u) << off;
    EXPECT_NE(robot.news[0].find("lidar: stamps are"), std::string::npos) << robot.news[0];
    EXPECT_GE(robot.unclear[kLidar], 13) << "of the first 1.5 s";
    EXPECT_LE(robot.unclear[kLidar], 18);
    EXPECT_NE(robot.news[0].find(off < 0 ? "behind" : "ahead"), std::string::npos) << robot.news[0];
    robot.worst[kLidar] = 0.0;
    robot.run(60.0);
    EXPECT_LT(robot.worst[kLidar], 0.2) << off;
    EXPECT_LT(robot.worst[kImu], 1e-9) << "the clock of the others is right";
    EXPECT_EQ(robot.news.size(), 1u);
  }
}

TEST(ClockOffsets, OfTwoSensorsTheOneNearerToTheComputersClockIsRight) {
  Robot robot(2);
  robot.there[kGps] = robot.there[static_cast<std::size_t>(Source::kWheel)] = false;
  robot.off[kLidar] = -18.0;
  robot.run(5.0);
  EXPECT_NEAR(to_seconds(robot.offsets.correction(Source::kLidar)), 18.0, 0.2);
  EXPECT_EQ(robot.offsets.correction(Source::kImu), Duration::zero());
  Robot alone(3);
  for (const std::size_t k : {kImu, kGps, std::size_t{3}}) alone.there[k] = false;
  alone.off[kLidar] = -18.0;
  alone.run(10.0);
  EXPECT_TRUE(alone.news.empty()) << "nothing to compare with";
  EXPECT_EQ(alone.offsets.behind(Source::kLidar), std::nullopt);
}

TEST(ClockOffsets, FollowsAStepBothWaysWithinSomeSamples) {
  for (const double step : {-5.0, 5.0}) {
    Robot robot(4);
    robot.run(20.0);
    robot.off[kLidar] = step;
    robot.run(0.5);
    robot.worst[kLidar] = 0.0;
    robot.run(20.0);
    EXPECT_LT(robot.worst[kLidar], 0.2) << step;
    ASSERT_EQ(robot.news.size(), 1u);
    robot.off[kLidar] = 0.0;
    robot.run(20.0);
    ASSERT_EQ(robot.news.size(), 2u);
    EXPECT_NE(robot.news[1].find("again"), std::string::npos);
    robot.worst[kLidar] = 0.0;
    robot.run(20.0);
    EXPECT_LT(robot.worst[kLidar], 0.05);
  }
}

TEST(ClockOffsets, AClockThatAllShareMayBeSet) {
  Robot robot(5);
  robot.run(20.0);
  for (double& off : robot.off) off = -5.0;
  robot.run(20.0);
  EXPECT_TRUE(robot.news.empty()) << robot.news.front();
  for (std::size_t k = 0; k < kSources; ++k)
    EXPECT_EQ(robot.offsets.correction(static_cast<Source>(k)), Duration::zero()) << k;
}

TEST(ClockOffsets, AProgramThatStoodStillTakesNothingForAStep) {
  Robot robot(6);
  robot.run(20.0);
  robot.run(10.0, 4.0);
  robot.run(20.0);
  EXPECT_TRUE(robot.news.empty()) << robot.news.front();
  EXPECT_LT(robot.worst[kLidar], 1e-9);
}

TEST(ClockOffsets, FollowsAClockThatDrifts) {
  Robot robot(7);
  robot.off[kLidar] = -2.0;
  robot.drift[kLidar] = 100e-6;
  robot.run(10.0);
  robot.worst[kLidar] = 0.0;
  robot.run(1800.0);
  EXPECT_LT(robot.worst[kLidar], 0.2);
  EXPECT_EQ(robot.news.size(), 1u);
}

TEST(ClockOffsets, AnOffsetOfJustASecondIsNotCorrectedOnAndOff) {
  Robot robot(9);
  robot.there[kGps] = false;
  robot.off[kLidar] = -0.9;  // with a driver that takes 0.11 s and more
  robot.run(10.0);
  ASSERT_NE(robot.offsets.correction(Source::kLidar), Duration::zero());
  for (int k = 0; k < 100; ++k) {
    robot.off[kLidar] = k % 2 ? -0.9 : -0.85;
    robot.run(1.0);
    ASSERT_NEAR(to_seconds(robot.offsets.correction(Source::kLidar)), 1.0, 0.2) << k;
  }
}

TEST(ClockOffsets, ASlowDriverIsToldAndNotCorrected) {
  Robot robot(8);
  robot.off[kGps] = -0.7;
  robot.run(30.0);
  ASSERT_EQ(robot.news.size(), 1u);
  EXPECT_NE(robot.news[0].find("slow driver"), std::string::npos);
  EXPECT_EQ(robot.offsets.correction(Source::kGps), Duration::zero());
}

}  // namespace
}  // namespace fleetmap::sensor
