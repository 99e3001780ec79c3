#include "fleetmap/sensor/stream_silence.hpp"

#include <gmock/gmock.h>

#include <functional>

#include "sensor/stamps.hpp"

namespace fleetmap::sensor {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// A drive of 1 m/s by scans of 10 Hz; samples come every `interval` where `heard`.
struct PartlyHeardDrive {
  double seconds = 41.0, interval = 0.2, speed = 1.0;
  std::function<bool(double)> heard = [](double) { return true; };

  StreamSilence driven(SilenceRule rule) const {
    StreamSilence silence(std::move(rule));
    double next = 0.0;
    for (int k = 0; k < static_cast<int>(10.0 * seconds); ++k) {
      const double t = 0.1 * k;
      silence.pass(k == 0 ? 0.0 : 0.1, 0.1 * speed);
      for (; next <= t; next += interval) {
        if (heard(next)) silence.add(at(next));
      }
    }
    return silence;
  }
};

TEST(StreamSilence, NothingIsSaidOfSensorsThatAreHeardAtTheirOwnRate) {
  for (const double interval : {0.02, 0.2, 1.0, 5.0}) {
    auto fixes = PartlyHeardDrive{.seconds = 200.0, .interval = interval}.driven(fix_silence());
    EXPECT_EQ(fixes.take_finding(), std::nullopt);
    EXPECT_EQ(fixes.note(), std::nullopt) << interval;
  }
  EXPECT_EQ(PartlyHeardDrive{.interval = 0.05}.driven(wheel_silence()).note(), std::nullopt);
}

TEST(StreamSilence, AnOutageOfGpsIsANoteWithItsTimes) {
  auto fixes =
      PartlyHeardDrive{.seconds = 100.0, .heard = [](double t) { return t < 50.0 || t > 70.0; }}.driven(
          fix_silence());
  EXPECT_EQ(fixes.take_finding(), std::nullopt);
  EXPECT_EQ(fixes.note(), "GPS: no fix from 50 s to 70 s of the drive");
  auto twice = PartlyHeardDrive{
      .seconds = 100.0, .heard = [](double t) {
        return t < 20.0 || (t > 30.0 && t < 80.0);
      }}.driven(fix_silence());
  EXPECT_EQ(twice.take_finding(), std::nullopt);
  EXPECT_EQ(twice.note(),
            "GPS: no fix in 2 gaps, together 30 s; the longest is from 80 s to 100 s of the drive, its end");
}

TEST(StreamSilence, MessagesWithoutAPositionAreToldFromNone) {
  StreamSilence never(fix_silence()), no_more(fix_silence());
  for (int k = 0; k < 1000; ++k) {
    never.pass(0.1, 0.1);
    no_more.pass(0.1, 0.1);
    if (k % 2 == 0) never.add_empty();
    if (k % 2 == 0 && k < 300) no_more.add(at(0.1 * k));
    if (k % 2 == 0 && k >= 300) no_more.add_empty();
  }
  const std::string in_vain = never.take_finding().value_or(""), ended = no_more.take_finding().value_or("");
  EXPECT_THAT(in_vain,
              AllOf(HasSubstr("GPS: no fix in the first 60 s: "),
                    HasSubstr("messages came without a position (status -1)"), HasSubstr("antenna")));
  EXPECT_EQ(never.take_finding(), std::nullopt);
  EXPECT_THAT(ended,
              AllOf(HasSubstr("GPS: no fix since 30 s"), HasSubstr("messages came without a position")));
  StreamSilence dead(fix_silence());
  for (int k = 0; k < 1000; ++k) {
    dead.pass(0.1, 0.1);
    if (k % 2 == 0 && k < 300) dead.add(at(0.1 * k));
  }
  EXPECT_THAT(dead.take_finding().value_or(""), HasSubstr("No message came: check cable, driver"));
}

TEST(StreamSilence, FixesThatEndAreAFindingWhereThatIsLongForTheDrive) {
  const auto ends_at_20_s = [](double t) { return t < 20.0; };
  auto fixes = PartlyHeardDrive{.seconds = 100.0, .heard = ends_at_20_s}.driven(fix_silence());
  EXPECT_THAT(fixes.take_finding().value_or(""), HasSubstr("GPS: no fix since 20 s of the drive"));
  EXPECT_EQ(fixes.take_finding(), std::nullopt);
  EXPECT_THAT(fixes.note().value_or(""), HasSubstr("from 20 s to 100 s of the drive, its end"));
  auto tunnel = PartlyHeardDrive{.seconds = 70.0, .heard = ends_at_20_s}.driven(fix_silence());
  EXPECT_EQ(tunnel.take_finding(), std::nullopt) << "50 s early in a drive";
  EXPECT_NE(tunnel.note(), std::nullopt);
  auto late =
      PartlyHeardDrive{.seconds = 4000.0, .heard = [](double t) { return t < 3000.0; }}.driven(fix_silence());
  EXPECT_THAT(late.take_finding().value_or(""), HasSubstr("since 3000 s")) << "ten minutes";
}

TEST(StreamSilence, WheelsThatEndAreAFinding) {
  const auto first_half = [](double t) { return t < 20.0; };
  auto wheels = PartlyHeardDrive{.interval = 0.05, .heard = first_half}.driven(wheel_silence());
  EXPECT_THAT(wheels.take_finding().value_or(""),
              AllOf(HasSubstr("wheel odometry: no sample since 20 s"), HasSubstr("Check the cable")));
  auto standing =
      PartlyHeardDrive{.interval = 0.05, .speed = 0.0, .heard = first_half}.driven(wheel_silence());
  EXPECT_EQ(standing.take_finding(), std::nullopt) << "some drivers are silent at standstill";
  EXPECT_EQ(standing.note(), std::nullopt);
}

TEST(StreamSilence, WheelsThatEndLateInALongDriveAreAFinding) {
  auto wheels = PartlyHeardDrive{
      .seconds = 3640.0, .interval = 0.05, .heard = [](double t) {
        return t < 3600.0;
      }}.driven(wheel_silence());
  EXPECT_THAT(wheels.take_finding().value_or(""), HasSubstr("since 3600 s of the drive, for 30 s"));
}

TEST(StreamSilence, ScansThatAreWorkedOnLateAreNoGap) {
  StreamSilence wheels(wheel_silence());
  for (int k = 0; k < 990; ++k) {
    wheels.add(at(0.05 * k));
    // Those of 2 s at once.
    for (int scan = 0; k % 40 == 39 && scan < 20; ++scan) wheels.pass(0.1, 0.1);
  }
  EXPECT_EQ(wheels.note(), std::nullopt);
}

TEST(StreamSilence, ASensorThatWasNeverHeardIsNotSilent) {
  auto none = PartlyHeardDrive{.heard = [](double) { return false; }}.driven(fix_silence());
  EXPECT_EQ(none.take_finding(), std::nullopt);
  EXPECT_EQ(none.note(), std::nullopt);
}

}  // namespace
}  // namespace fleetmap::sensor
