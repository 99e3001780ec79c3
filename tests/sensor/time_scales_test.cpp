#include "time_scales.hpp"

#include <gtest/gtest.h>

namespace fleetmap::sensor {
namespace {

const Stamp kNow = stamp_from_ns(1'700'000'000'000'000'000);

TEST(TimeScales, AnOffsetNearADifferenceOfTwoScalesIsThatDifference) {
  EXPECT_EQ(nearest_of_time_scales(18.25), 18.0);
  EXPECT_EQ(nearest_of_time_scales(-17.75), -18.0);
  EXPECT_EQ(nearest_of_time_scales(37.2), 37.0);
  EXPECT_EQ(nearest_of_time_scales(-19.2), -19.0);
  EXPECT_EQ(nearest_of_time_scales(3599.8), 3600.0);
  EXPECT_EQ(nearest_of_time_scales(-20699.9), -20700.0) << "Nepal: 5 h 45 min";
  EXPECT_EQ(nearest_of_time_scales(50400.1), 50400.0) << "Kiribati: 14 h";
}

TEST(TimeScales, AnyOtherOffsetStaysWhatItIs) {
  for (const double offset : {0.0, 0.2, -0.2, 5.0, 18.4, -18.5, 37.4, 450.0, 900.4, 51300.0, -1.7e9})
    EXPECT_EQ(nearest_of_time_scales(offset), offset);
}

TEST(TimeScales, TheReasonNamesTheScales) {
  EXPECT_EQ(reason_of(17.8, kNow), " (the difference of GPS time and UTC)");
  EXPECT_EQ(reason_of(-37.0, kNow), " (the difference of TAI and UTC)");
  EXPECT_EQ(reason_of(19.1, kNow), " (the difference of TAI and GPS time)");
  EXPECT_EQ(reason_of(-7200.0, kNow), " (a time zone)");
  for (const double offset : {0.0, 2.5, 18.4, 51300.0}) EXPECT_EQ(reason_of(offset, kNow), "") << offset;
}

TEST(TimeScales, StampsOfTheFirstYearsSince1970CountFromTheSensorsStart) {
  const Stamp of_boot = stamp_from_ns(7'000'000'000);
  EXPECT_EQ(reason_of(1.7e9, of_boot), " (they count from the sensor's start)");
  EXPECT_EQ(reason_of(1.7e9, kNow), "") << "a receiver's clock that is years off";
  EXPECT_EQ(reason_of(-1.7e9, of_boot), "") << "no sensor counts from the future";
  EXPECT_EQ(reason_of(1e6, of_boot), "") << "the computer itself has no clock";
}

}  // namespace
}  // namespace fleetmap::sensor
