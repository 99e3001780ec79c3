#include "checked_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "bus/captured_log.hpp"
#include "recording/timed_samples.hpp"

namespace fleetmap::recording {
namespace {

using namespace std::chrono_literals;
using testing::at;
using ::testing::ElementsAre;

/// Offers its checks alone.
class Checks : public CheckedReader {
 public:
  explicit Checks(ScanContent content = ScanContent::kPoints) : CheckedReader("drive", content) {}
  Result<std::optional<Sample>> next() override { return std::optional<Sample>(); }
  using CheckedReader::admit;
  using CheckedReader::admit_points;
  using CheckedReader::skip;

  /// Whether IMU samples at these times are given out, one after the other.
  std::vector<bool> imus(std::initializer_list<Duration> times) {
    std::vector<bool> admitted;
    for (const Duration time : times) admitted.push_back(admit(at<sensor::Imu>(time)));
    return admitted;
  }
};

TEST(CheckedReader, GivesOutWhatIsLaterThanTheOneBefore) {
  Checks checks;
  EXPECT_THAT(checks.imus({0s, 1ns, 1ns, 0s, 2ns}), ElementsAre(true, true, false, false, true));
  EXPECT_EQ(checks.counters().imus, 3u);
  EXPECT_EQ(checks.counters().time_backwards, 2u);
  EXPECT_EQ(checks.counters().clocks_set_back, 0u);
}

TEST(CheckedReader, EachKindHasItsOwnTimeAndCount) {
  Checks checks;
  checks.imus({100s});
  EXPECT_TRUE(checks.admit(at<sensor::Scan>(0s)));
  EXPECT_TRUE(checks.admit(at<sensor::Fix>(0s)));
  EXPECT_TRUE(checks.admit(at<sensor::Wheel>(0s)));
  EXPECT_FALSE(checks.admit(at<sensor::Wheel>(0s)));
  const Counters& counters = checks.counters();
  EXPECT_THAT((std::array{counters.scans, counters.imus, counters.fixes, counters.wheels}),
              ElementsAre(1, 1, 1, 1));
}

TEST(CheckedReader, ThreeInOrderFarBeforeMeanThatTheClockWasSetBack) {
  Checks checks;
  EXPECT_THAT(checks.imus({100s, 0s, 1s, 2s, 3s}), ElementsAre(true, false, false, true, true));
  EXPECT_EQ(checks.counters().time_backwards, 2u);
  EXPECT_EQ(checks.counters().clocks_set_back, 1u);
  EXPECT_THAT(checks.imus({2s, 2s + 1ms, 2s + 2ms, 4s}), ElementsAre(false, false, false, true))
      << "these are not more than 1 s before";
  EXPECT_EQ(checks.counters().clocks_set_back, 1u);
}

TEST(CheckedReader, ThoseOutOfOrderOrNearDoNotMeanIt) {
  Checks out_of_order;
  EXPECT_THAT(out_of_order.imus({100s, 2s, 1s, 0s, 50s, 99s}),
              ElementsAre(true, false, false, false, false, false));
  Checks near_between;
  EXPECT_THAT(near_between.imus({100s, 1s, 2s, 99s + 1ms, 3s, 4s, 5s}),
              ElementsAre(true, false, false, false, false, false, true))
      << "counting began again after the near one";
  Checks late;
  EXPECT_THAT(late.imus({100s, 1s, 2s, 101s, 3s}), ElementsAre(true, false, false, true, false));
}

TEST(CheckedReader, AScanWithoutReturnsIsLeftOut) {
  Checks checks;
  ros_codec::DecodedScan scan;
  scan.non_finite_points = 5;
  EXPECT_FALSE(checks.admit_points(scan, "a scan"));
  EXPECT_EQ(checks.counters().empty_scans, 1u);
  EXPECT_EQ(checks.counters().non_finite_points, 0u) << "only of the scans that are read";
  scan.scan.points.resize(1);
  scan.origin_points = 7;
  EXPECT_TRUE(checks.admit_points(scan, "a scan"));
  EXPECT_EQ(checks.counters().foreign_time_unit_scans + checks.counters().foreign_clock_scans, 0u);
  scan.time_unit = ros_codec::TimeUnit::kMilliseconds;
  scan.foreign_clock = true;
  EXPECT_TRUE(checks.admit_points(scan, "a scan"));
  EXPECT_EQ(checks.counters().non_finite_points, 10u);
  EXPECT_EQ(checks.counters().origin_points, 14u);
  EXPECT_TRUE(checks.admit_points(scan, "another scan"));
  EXPECT_EQ(checks.counters().foreign_time_unit_scans, 2u);
  EXPECT_EQ(checks.findings(), std::vector{ros_codec::finding_of(ros_codec::TimeUnit::kMilliseconds)});
  EXPECT_EQ(checks.counters().foreign_clock_scans, 2u);
}

TEST(CheckedReader, OneOfStampsOnlyCountsAndLogsNothing) {
  for (const ScanContent content : {ScanContent::kPoints, ScanContent::kStampOnly}) {
    bus::testing::CapturedLog log;
    Checks checks(content);
    checks.skip(&Counters::damaged_parts, "a part");
    checks.imus({100s, 1s, 2s, 3s});
    EXPECT_EQ(checks.counters().damaged_parts + checks.counters().clocks_set_back, 2u);
    EXPECT_THAT(checks.findings(),
                ElementsAre(::testing::HasSubstr("imu samples was set back by 97.00 s: ")));
    EXPECT_EQ(log.count("drive: damaged_parts: a part") + log.count("set back by"),
              content == ScanContent::kPoints ? 2 : 0);
  }
}

TEST(CheckedReader, CountersHaveTheirNames) {
  Checks checks;
  checks.skip(&Counters::missing_scan_frames, "frames", 4);
  checks.skip(&Counters::damaged_parts, "a part");
  checks.imus({0s});
  std::map<std::string, std::uint64_t> found;
  for (const auto& [name, count] : checks.counters().named()) {
    if (count > 0) found.emplace(name, count);
  }
  EXPECT_EQ(found, (std::map<std::string, std::uint64_t>{
                       {"missing_scan_frames", 4}, {"damaged_parts", 1}, {"imus", 1}}));
  // Every counter is an integer of the struct, and none is left out.
  EXPECT_EQ(checks.counters().named().size(), sizeof(Counters) / sizeof(std::uint64_t));
}

}  // namespace
}  // namespace fleetmap::recording
