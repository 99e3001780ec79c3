#include "fleetmap/sensor/clock_offsets.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <string>

namespace fleetmap::sensor {
namespace {

constexpr double kNowSeconds = 1.7e9;  // s since 1970

/// A robot whose sensors have stamps that may be off, and drivers that take their time.
class Robot {
 public:
  explicit Robot(std::uint32_t seed) : random_(seed) {}

  double off[kSources] = {};    ///< s, added to stamps
  double drift[kSources] = {};  ///< s a second
  bool there[kSources] = {true, true, true, true};
  double held[kSources] = {};  ///< s, for which a busy computer holds each sample of this sensor back

  /// Lets `seconds` pass; `stall` of them the program stands still and then finds all that came.
  void run(double seconds, double stall = 0.0) {
    constexpr double kPeriod[kSources] = {0.1, 0.01, 1.0, 0.05}, kDriver[kSources] = {0.11, 0.002, 0.2, 0.01};
    const double end = time_ + seconds, awake = time_ + stall;
    for (; time_ < end; time_ += 0.01) {
      for (std::size_t k = 0; k < kSources; ++k) {
        if (!there[k] || time_ < next_[k]) continue;
        next_[k] += kPeriod[k];
        const double late = kDriver[k] * (1.0 + std::exponential_distribution<double>(2.0)(random_));
        // No sample overtakes the one before it.
        handed_on_[k] = std::max({handed_on_[k], time_ + late + held[k], awake});
        arrivals_.emplace(handed_on_[k], Sample{k, time_});
      }
      for (; !arrivals_.empty() && arrivals_.begin()->first <= time_; arrivals_.erase(arrivals_.begin()))
        arrive(arrivals_.begin()->first, arrivals_.begin()->second);
    }
    for (std::string& text : offsets.take_warnings()) news.push_back(std::move(text));
  }
  double corrected(std::size_t k) const { return to_seconds(offsets.correction(static_cast<Source>(k))); }
  void forget_errors() {
    std::ranges::fill(worst, 0.0);
    std::ranges::fill(unclear, 0);
  }

  ClockOffsets offsets;
  double worst[kSources] = {};  ///< s, error of a corrected stamp
  int unclear[kSources] = {};   ///< samples
  std::vector<std::string> news;

 private:
  struct Sample {
    std::size_t source;
    double taken;  ///< s
  };
  void arrive(double arrival, const Sample& sample) {
    const std::size_t k = sample.source;
    const auto source = static_cast<Source>(k);
    const double error = off[k] + drift[k] * sample.taken;
    const Stamp stamp = at(sample.taken) + from_seconds(error);
    offsets.add(source, stamp, at(arrival));
    if (offsets.unclear(source)) return void(++unclear[k]);
    worst[k] =
        std::max(worst[k], std::abs(to_seconds(stamp + offsets.correction(source) - at(sample.taken))));
  }
  static Stamp at(double seconds) { return Stamp{} + from_seconds(kNowSeconds) + from_seconds(seconds); }
  std::mt19937 random_;
  double time_ = 0.0;
  double next_[kSources] = {};
  double handed_on_[kSources] = {};
  std::multimap<double, Sample> arrivals_;
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

/// A fault of one sensor's clock, and the expected warning.
struct WrongClock {
  const char* name;
  double off;        ///< s
  double drift;      ///< s a second
  const char* said;  ///< a regular expression, after the sensor's name
  double error;      ///< s, that remains at most
};
void PrintTo(const WrongClock& clock, std::ostream* out) { *out << clock.name; }
constexpr double kDrivers = 0.25;  // s: of the slowest of them
constexpr WrongClock kWrongClocks[] = {
    {"gps_time", 18.0, 0.0, "stamps are 18.00 s ahead of .*GPS time and UTC.*are corrected", 1e-6},
    {"utc_among_gps_time", -18.0, 0.0, "stamps are 18.00 s behind .*GPS time and UTC.*are corrected", 1e-6},
    {"tai", 37.0, 0.0, "stamps are 37.00 s ahead of .*TAI and UTC.*are corrected", 1e-6},
    {"utc_among_tai", -37.0, 0.0, "stamps are 37.00 s behind .*TAI and UTC.*are corrected", 1e-6},
    {"hour_ahead", 3600.0, 0.0, "stamps are 3600.00 s ahead of .*time zone.*are corrected", 1e-6},
    {"hour_behind", -3600.0, 0.0, "stamps are 3600.00 s behind .*time zone.*are corrected", 1e-6},
    {"boot_time", 7.0 - kNowSeconds, 0.0,
     "stamps are 169999999[23].[0-9]+ s behind .*sensor's start.*are corrected", kDrivers},
    {"few_seconds", -2.5, 0.0, "stamps are 2.[3-7][0-9] s behind .*are corrected", kDrivers},
    {"fast", 0.0, 100e-6, "clock runs (9[5-9]|10[0-5]) ppm too fast .*corrected", 0.075},
    {"slow", 0.0, -100e-6, "clock runs (9[5-9]|10[0-5]) ppm too slow .*corrected", 0.075},
};

TEST(ClockOffsets, ADriftThatIsFoundAgainIsNamedOnce) {
  // On the edge of what counts as a drift, so that it comes and goes.
  for (std::uint32_t seed = 0; seed < 2; ++seed) {
    for (const double drift : {30e-6, 40e-6}) {
      Robot robot(seed);
      robot.drift[kImu] = drift;
      robot.run(3600.0);
      std::set<std::string> sentences(robot.news.begin(), robot.news.end());
      EXPECT_EQ(sentences.size(), robot.news.size()) << ::testing::PrintToString(robot.news);
      EXPECT_LE(robot.news.size(), 1u) << ::testing::PrintToString(robot.news);
    }
  }
}

class OneClockIsWrong : public ::testing::TestWithParam<std::tuple<WrongClock, std::size_t>> {};

TEST_P(OneClockIsWrong, IsNamedWithItsOffsetAndUsed) {
  const auto& [clock, k] = GetParam();
  Robot robot(1);
  robot.off[k] = clock.off;
  robot.drift[k] = clock.drift;
  robot.run(16.0);
  EXPECT_LT(robot.unclear[kImu], k == kImu ? 1100 : 220) << "samples";
  robot.forget_errors();
  robot.run(clock.drift == 0.0 ? 120.0 : 584.0);
  EXPECT_EQ(robot.news.size(), 1u) << "a drift is named within 10 min";
  if (clock.drift != 0.0) robot.run(1200.0);
  ASSERT_EQ(robot.news.size(), 1u) << ::testing::PrintToString(robot.news);
  EXPECT_THAT(robot.news[0],
              ::testing::ContainsRegex(std::string(to_string(static_cast<Source>(k))) + ": .*" + clock.said));
  for (std::size_t other = 0; other < kSources; ++other) {
    EXPECT_EQ(robot.unclear[other], 0) << other;
    EXPECT_LT(robot.worst[other], other == k ? clock.error : 1e-9) << other;
  }
}

std::string case_name(const ::testing::TestParamInfo<std::tuple<WrongClock, std::size_t>>& info) {
  const auto& [clock, k] = info.param;
  return std::string(clock.name) + "_of_" + to_string(static_cast<Source>(k));
}

INSTANTIATE_TEST_SUITE_P(ClockOffsets, OneClockIsWrong,
                         ::testing::Combine(::testing::ValuesIn(kWrongClocks),
                                            ::testing::Range<std::size_t>(0, kSources)),
                         case_name);

/// A sensor whose clock is right, on a computer that holds its samples back for up to 3 s now and then.
class OneSensorIsLate : public ::testing::TestWithParam<std::size_t> {};

TEST_P(OneSensorIsLate, AtTheStartAndNowAndThenIsNotCalledWrong) {
  const std::size_t k = GetParam();
  for (std::uint32_t seed = 0; seed < 5; ++seed) {
    Robot robot(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> hold(0.5, 3.0), busy(0.5, 8.0), idle(1.0, 20.0);
    for (int burst = 0; burst < 30; ++burst) {
      robot.held[k] = hold(random);
      robot.run(busy(random));
      robot.held[k] = 0.0;
      robot.run(idle(random) + 3.0);
    }
    EXPECT_TRUE(robot.news.empty()) << ::testing::PrintToString(robot.news);
    for (const double error : robot.worst) EXPECT_LT(error, 1e-9);
    robot.forget_errors();
    // It is not that it no longer looks.
    robot.off[k] = -18.0;
    robot.run(60.0);
    EXPECT_EQ(robot.corrected(k), 18.0);
  }
}

INSTANTIATE_TEST_SUITE_P(ClockOffsets, OneSensorIsLate, ::testing::Range<std::size_t>(0, kSources),
                         [](const auto& info) { return to_string(static_cast<Source>(info.param)); });

TEST(ClockOffsets, SensorsThatAreAllLateTogetherAreNotCalledWrong) {
  Robot robot(3);
  for (int burst = 0; burst < 10; ++burst) {
    std::ranges::fill(robot.held, 3.0);
    robot.run(6.0);
    std::ranges::fill(robot.held, 0.0);
    robot.run(10.0);
  }
  EXPECT_TRUE(robot.news.empty()) << robot.news.front();
  for (const double error : robot.worst) EXPECT_LT(error, 1e-9);
}

TEST(ClockOffsets, OfTwoSensorsTheOneNearerToTheComputersClockIsRight) {
  Robot robot(2);
  robot.there[kGps] = robot.there[static_cast<std::size_t>(Source::kWheel)] = false;
  robot.off[kLidar] = -18.0;
  robot.run(5.0);
  EXPECT_EQ(robot.corrected(kLidar), 18.0);
  EXPECT_EQ(robot.offsets.correction(Source::kImu), Duration::zero());
}

/// Nothing shows whether its clock or the computer's is wrong.
TEST(ClockOffsets, ASensorThatIsAloneIsComparedWithTheComputersAndUsedAsItIs) {
  const std::map<double, const char*> said{
      {0.0, nullptr},
      {18.0, "18.00 s ahead of the computer's clock .*GPS time and UTC.*used as they are"},
      {37.0, "37.00 s ahead of the computer's clock .*TAI and UTC.*used as they are"},
      {-3600.0, "3600.00 s behind the computer's clock .*time zone.*used as they are"},
      {-2.5, "2.[56][0-9] s behind the computer's clock; .*used as they are"},
      {7.0 - kNowSeconds,
       "169999999[23].[0-9]+ s behind the computer's clock .*sensor's start.*used as they are"}};
  for (const auto& [off, text] : said) {
    Robot robot(3);
    for (const std::size_t k : {kImu, kGps, std::size_t{3}}) robot.there[k] = false;
    robot.off[kLidar] = off;
    robot.run(60.0);
    EXPECT_EQ(robot.offsets.correction(Source::kLidar), Duration::zero());
    EXPECT_LE(robot.unclear[kLidar], 5) << "scans, for which others may come";
    EXPECT_NEAR(robot.offsets.behind(Source::kLidar).value(), -off, 0.2);
    ASSERT_EQ(robot.news.size(), text == nullptr ? 0u : 1u) << ::testing::PrintToString(robot.news);
    if (text != nullptr) {
      EXPECT_THAT(robot.news[0], ::testing::ContainsRegex(text));
    }
  }
}

TEST(ClockOffsets, ASensorThatWasAloneIsCorrectedOnceOthersCome) {
  Robot robot(3);
  for (const std::size_t k : {kImu, kGps, std::size_t{3}}) robot.there[k] = false;
  robot.off[kLidar] = 18.0;
  robot.run(60.0);
  for (const std::size_t k : {kImu, kGps, std::size_t{3}}) robot.there[k] = true;
  robot.run(20.0);
  EXPECT_EQ(robot.corrected(kLidar), -18.0);
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
  robot.run(10.0);
  robot.worst[kLidar] = 0.0;
  robot.run(1780.0);
  EXPECT_LT(robot.worst[kLidar], 0.2);
  ASSERT_EQ(robot.news.size(), 2u);
  EXPECT_NE(robot.news[1].find("ppm too fast"), std::string::npos) << robot.news[1];
  EXPECT_NEAR(robot.offsets.slow_ppm(Source::kLidar).value(), -100.0, 5.0);
}

TEST(ClockOffsets, AStepIsNoDrift) {
  for (const double step : {-0.35, -0.1, 0.1, 0.35}) {
    Robot robot(10);
    robot.run(900.0);
    robot.off[kLidar] = step;
    robot.run(1800.0);
    EXPECT_TRUE(robot.news.empty()) << step << ' ' << robot.news.front();
    EXPECT_LT(robot.worst[kLidar], 0.36);
  }
}

TEST(ClockOffsets, AComputerThatBecomesBusierMakesNoDrift) {
  Robot robot(11);
  for (int minute = 0; minute < 40; ++minute) {
    robot.held[kLidar] = 1e-3 * minute;
    robot.run(60.0);
  }
  EXPECT_TRUE(robot.news.empty()) << robot.news.front();
}

TEST(ClockOffsets, AnOffsetOfJustASecondIsNotCorrectedOnAndOff) {
  Robot robot(9);
  robot.there[kGps] = false;
  robot.off[kLidar] = -0.9;  // with a driver that takes 0.11 s and more
  robot.run(15.0);
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
