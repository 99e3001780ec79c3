// Bags of robots one of whose sensors has another clock: what is found when they are played.
#include <gmock/gmock.h>

#include "bag_samples.hpp"
#include "fleetmap/recording/play_times.hpp"
#include "fleetmap/recording/survey.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/sensor/clock_offsets.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::recording::testing {
namespace {

using fleetmap::testing::TemporaryFolder;
using sensor::Source;

/// A fault of one sensor's clock, and the expected warning.
struct WrongClock {
  const char* name;
  double off;        ///< s
  double drift;      ///< s a second
  const char* said;  ///< a regular expression
  double error;      ///< s, that remains at most
};
void PrintTo(const WrongClock& clock, std::ostream* out) { *out << clock.name; }
constexpr double kDrive = 1e-9 * static_cast<double>(kStart);  // s
constexpr WrongClock kWrongClocks[] = {
    {"gps_time", 18.0, 0.0, "18.00 s ahead of", 1e-6},
    {"utc_among_gps_time", -18.0, 0.0, "18.00 s behind", 1e-6},
    {"tai", 37.0, 0.0, "37.00 s ahead of", 1e-6},
    {"hour", 3600.0, 0.0, "3600.00 s ahead of", 1e-6},
    {"boot_time", 7.0 - kDrive, 0.0, "169999999[23].[0-9]+ s behind .*sensor's start", 0.15},
    {"fast", 0.0, 100e-6, "clock runs (9[5-9]|10[0-5]) ppm too fast", 0.075},
};

class SensorClocks : public ::testing::TestWithParam<std::tuple<WrongClock, std::size_t>> {
 protected:
  /// All sensors at 10 Hz, GPS at 1 Hz; samples are recorded some time after they were taken.
  void write(double seconds) {
    constexpr double kLatency[] = {0.105, 0.002, 0.08, 0.01};
    const auto& [clock, wrong] = GetParam();
    auto bag = BagWriter::create(folder_);
    ASSERT_TRUE(bag);
    for (int k = 0; k < static_cast<int>(seconds * 10.0); ++k) {
      const double t = 0.1 * k;
      for (std::size_t source = 0; source < sensor::kSources; ++source) {
        if (source == static_cast<std::size_t>(Source::kGps) && k % 10 != 0) continue;
        const double error = source == wrong ? clock.off + clock.drift * t : 0.0;
        write(*bag, source, kStart + from_seconds(t).count() + from_seconds(error).count(),
              kStart + from_seconds(t + kLatency[source]).count());
      }
    }
    ASSERT_TRUE(bag->close());
  }
  static void write(BagWriter& bag, std::size_t source, std::int64_t stamp, std::int64_t received) {
    switch (static_cast<Source>(source)) {
      case Source::kLidar:
        return put(bag, ros_codec::topics::points(), received, ros_codec::encode(scan_at(stamp)));
      case Source::kImu:
        return put(bag, ros_codec::topics::imu(), received, ros_codec::encode(imu_at(stamp)));
      case Source::kGps:
        return put(bag, ros_codec::topics::fix(), received, ros_codec::encode(fix_at(stamp)));
      case Source::kWheel:
        return put(bag, ros_codec::topics::wheel_odometry(), received,
                   ros_codec::encode(sensor::Wheel{stamp_from_ns(stamp), 1.0, {}}));
    }
  }

  const TemporaryFolder temporary_;
  const std::filesystem::path folder_ = temporary_.path() / "drive";
};

TEST_P(SensorClocks, AreFoundWhenABagIsPlayed) {
  const auto& [clock, wrong] = GetParam();
  const double seconds = clock.drift == 0.0 ? 30.0 : 1800.0;
  write(seconds);
  auto reader = open(folder_);
  ASSERT_TRUE(reader) << reader.error().message;
  PlayTimes times(survey(folder_).value().clock);
  sensor::ClockOffsets offsets;
  std::vector<std::string> news;
  std::optional<Stamp> first, last;
  double worst = 0.0;
  int read = 0, used = 0;
  const double rate = static_cast<Source>(wrong) == Source::kGps ? 1.0 : 10.0;  // Hz
  while (true) {
    const auto sample = (*reader)->next();
    ASSERT_TRUE(sample) << sample.error().message;
    if (!*sample) break;
    const auto source = static_cast<Source>((*sample)->index());
    const Stamp stamp = stamp_of(**sample);
    const Stamp played = times.of(**sample, (*reader)->recorded());
    EXPECT_GE(played, last.value_or(played));
    last = played;
    if (!first) first = played;
    offsets.add(source, stamp, played);
    for (std::string& text : offsets.take_warnings()) news.push_back(std::move(text));
    if ((*sample)->index() != wrong) {
      EXPECT_EQ(offsets.correction(source), Duration::zero());
      continue;
    }
    const Stamp taken = stamp_from_ns(kStart) + from_seconds(read++ / rate);
    if (offsets.unclear(source)) continue;
    ++used;
    worst = std::max(worst, std::abs(to_seconds(stamp + offsets.correction(source) - taken)));
  }
  EXPECT_NEAR(to_seconds(*last - *first), seconds, 0.3) << "a bag takes as long as its drive";
  ASSERT_EQ(news.size(), 1u) << ::testing::PrintToString(news);
  EXPECT_THAT(news[0], ::testing::StartsWith(sensor::to_string(static_cast<Source>(wrong))));
  EXPECT_THAT(news[0], ::testing::ContainsRegex(clock.said));
  EXPECT_LT(worst, clock.error);
  EXPECT_GT(used, rate * (seconds - 4.0));
}

std::string case_name(const ::testing::TestParamInfo<std::tuple<WrongClock, std::size_t>>& info) {
  const auto& [clock, wrong] = info.param;
  return std::string(clock.name) + "_of_" + sensor::to_string(static_cast<Source>(wrong));
}

INSTANTIATE_TEST_SUITE_P(Bags, SensorClocks,
                         ::testing::Combine(::testing::ValuesIn(kWrongClocks),
                                            ::testing::Range<std::size_t>(0, sensor::kSources)),
                         case_name);

/// Right sensors at 10 Hz and GPS at 1 Hz, for 20 s of the drive, recorded from `begun` s after it at
/// `rate` s a second.
LogClock clock_of_bag(double begun, double rate) {
  const TemporaryFolder temporary;
  const std::filesystem::path folder = temporary.path() / "drive";
  auto bag = BagWriter::create(folder).value();
  for (int k = 0; k < 200; ++k) {
    const std::int64_t stamp = kStart + k * 100'000'000LL;
    const auto received = kStart + static_cast<std::int64_t>(1e9 * (begun + rate * 0.1 * k));
    put(bag, ros_codec::topics::points(), received + 100'000'000, ros_codec::encode(scan_at(stamp)));
    put(bag, ros_codec::topics::imu(), received + 100'000'000, ros_codec::encode(imu_at(stamp)));
    if (k % 10 == 0)
      put(bag, ros_codec::topics::fix(), received + 100'000'000, ros_codec::encode(fix_at(stamp)));
  }
  EXPECT_TRUE(bag.close());
  return survey(folder).value().clock;
}

/// Decoding costs far more than reading, and the player decodes every scan anyway.
TEST(LogClock, NeedsNoMoreOfAScanThanItsStamp) {
  const TemporaryFolder temporary;
  const std::filesystem::path folder = temporary.path() / "drive";
  auto bag = BagWriter::create(folder).value();
  for (int k = 0; k < 100; ++k) {
    const std::int64_t stamp = kStart + k * 100'000'000LL;
    Bytes scan = ros_codec::encode(scan_at(stamp));
    scan.resize(scan.size() / 2);
    put(bag, ros_codec::topics::points(), stamp + 300'000'000'000, scan);
  }
  EXPECT_TRUE(bag.close());
  EXPECT_NEAR(to_seconds(survey(folder).value().clock.shift), -300.0, 0.01);
  auto reader = open(folder, {}, ScanContent::kStampOnly).value();
  const auto sample = reader->next().value();
  ASSERT_TRUE(sample);
  EXPECT_EQ(to_ns(stamp_of(*sample)), kStart);
  EXPECT_TRUE(std::get<sensor::Scan>(*sample).points.empty());
}

TEST(LogClock, OfABagThatWasWrittenAgainLaterIsThatOfTheDrive) {
  for (const double later : {300.0, 5.0 * 3600.0, 100.0 * 86'400.0, -7200.0}) {
    const LogClock clock = clock_of_bag(later, 1.0);
    EXPECT_TRUE(clock.usable);
    EXPECT_NEAR(to_seconds(clock.shift), -later, 0.11);
  }
  EXPECT_EQ(clock_of_bag(0.0, 1.0).shift, Duration::zero());
}

TEST(LogClock, OfASlowSimulatorOrAPlaybackAtAnotherRateIsNotUsed) {
  for (const double rate : {0.5, 1.0 / 0.9, 2.0, 0.0}) EXPECT_FALSE(clock_of_bag(0.0, rate).usable) << rate;
  EXPECT_TRUE(clock_of_bag(0.0, 1.0001).usable);
  PlayTimes times(LogClock{false, {}});
  EXPECT_EQ(times.of(imu_at(kStart), stamp_from_ns(kStart + 7)), stamp_from_ns(kStart));
}

TEST(PlayTimes, WithoutTimesOfRecordingAClockThatWasSetBackGoesOn) {
  PlayTimes times;
  EXPECT_EQ(times.of(imu_at(kStart), std::nullopt), stamp_from_ns(kStart));
  EXPECT_EQ(times.of(imu_at(kStart - 500), std::nullopt), stamp_from_ns(kStart));
  EXPECT_EQ(times.of(imu_at(kStart - 400), std::nullopt), stamp_from_ns(kStart + 100));
}

}  // namespace
}  // namespace fleetmap::recording::testing
