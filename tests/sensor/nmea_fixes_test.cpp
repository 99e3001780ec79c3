#include "fleetmap/sensor/nmea_fixes.hpp"

#include <gtest/gtest.h>

#include <cstdio>

#include "fleetmap/core/utc.hpp"

namespace fleetmap::sensor {
namespace {

using namespace std::chrono_literals;

std::string sentence(const std::string& body) {
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  char text[8];
  std::snprintf(text, sizeof text, "*%02X\r\n", sum);
  return "$" + body + text;
}
std::string gga(const std::string& time, int quality = 1) {
  return sentence("GNGGA," + time + ",3900.000,N,00300.000,W," + std::to_string(quality) +
                  ",12,0.7,600.0,M,50.0,M,,");
}
std::string rmc(const std::string& time, const std::string& date, const char* status = "A") {
  return sentence("GNRMC," + time + "," + status + ",3900.000,N,00300.000,W,0.0,0.0," + date + ",,,A");
}
std::string gst(const std::string& time, const std::string& north) {
  return sentence("GNGST," + time + ",1.0,,,," + north + ",0.7,1.5");
}
std::vector<Fix> add(NmeaFixes& fixes, const std::string& text, const char* arrival) {
  return fixes.add(bytes_of(text), *from_utc(arrival)).fixes;
}

TEST(NmeaFixes, TheDayIsThatOfTheReceiverAndNotOfTheComputer) {
  NmeaFixes fixes;
  const auto found = add(fixes, rmc("101500.00", "251126") + gga("101500.00"), "1970-01-01T00:00:30Z");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(to_utc(found[0].stamp), "2026-11-25T10:15:00.000Z");
  EXPECT_TRUE(found[0].valid);
  EXPECT_NEAR(found[0].position.altitude, 650.0, 1e-9);
}

TEST(NmeaFixes, WithoutADateItIsTheDayNearestToTheArrival) {
  NmeaFixes fixes;
  EXPECT_EQ(to_utc(add(fixes, gga("235959.80"), "2026-11-26T00:00:00.10Z").at(0).stamp),
            "2026-11-25T23:59:59.800Z");
  EXPECT_EQ(to_utc(add(fixes, gga("000000.10"), "2026-11-25T23:59:59.90Z").at(0).stamp),
            "2026-11-26T00:00:00.100Z");
}

TEST(NmeaFixes, MidnightComesBetweenTheDateAndTheFix) {
  NmeaFixes fixes;
  add(fixes, rmc("235959.80", "311226"), "2026-12-31T23:59:59.90Z");
  EXPECT_EQ(to_utc(add(fixes, gga("000000.00"), "2027-01-01T00:00:00.10Z").at(0).stamp),
            "2027-01-01T00:00:00.000Z");
}

TEST(NmeaFixes, TheDateOfAReceiverWithoutAFixIsNotUsed) {
  NmeaFixes fixes;
  add(fixes, rmc("101500.00", "220899", "V"), "2026-11-25T10:15:00.10Z");
  EXPECT_EQ(to_utc(add(fixes, gga("101501.00"), "2026-11-25T10:15:01.10Z").at(0).stamp),
            "2026-11-25T10:15:01.000Z");
}

TEST(NmeaFixes, StandardDeviationsAreThoseOfTheSameMoment) {
  NmeaFixes fixes;
  auto found = add(fixes, gga("101500.00"), "2026-11-25T10:15:00.10Z");
  ASSERT_EQ(found.size(), 1u) << "nobody knows yet that GST will come";
  EXPECT_TRUE(found[0].covariance.isZero(0.0)) << "not stated";
  EXPECT_EQ(add(fixes, gst("101500.00", "0.5"), "2026-11-25T10:15:00.10Z").size(), 0u);
  EXPECT_EQ(add(fixes, gga("101501.00"), "2026-11-25T10:15:01.10Z").size(), 0u) << "waits for its GST";
  found = add(fixes, gst("101501.00", "0.6"), "2026-11-25T10:15:01.10Z");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].covariance(0, 0), 0.49, 1e-12) << "east";
  EXPECT_NEAR(found[0].covariance(1, 1), 0.36, 1e-12) << "north";
  EXPECT_NEAR(found[0].covariance(2, 2), 2.25, 1e-12);
}

TEST(NmeaFixes, AGstThatIsLostHoldsNoFixBack) {
  NmeaFixes fixes;
  add(fixes, gga("101500.00") + gst("101500.00", "0.5"), "2026-11-25T10:15:00.10Z");
  EXPECT_EQ(add(fixes, gga("101501.00"), "2026-11-25T10:15:01.10Z").size(), 0u);
  const auto found = add(fixes, gga("101502.00") + gst("101502.00", "0.5"), "2026-11-25T10:15:02.10Z");
  ASSERT_EQ(found.size(), 2u);
  EXPECT_TRUE(found[0].covariance.isZero(0.0)) << "another moment's are not its";
  EXPECT_FALSE(found[1].covariance.isZero(0.0));
}

TEST(NmeaFixes, AGstBeforeItsFixIsUsed) {
  NmeaFixes fixes;
  const auto found = add(fixes, gst("101500.00", "0.5") + gga("101500.00"), "2026-11-25T10:15:00.10Z");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_FALSE(found[0].covariance.isZero(0.0));
}

TEST(NmeaFixes, NoFixIsSaidAsSuch) {
  NmeaFixes fixes;
  EXPECT_FALSE(add(fixes, gga("101500.00", 0), "2026-11-25T10:15:00.10Z").at(0).valid);
}

TEST(NmeaFixes, MalformedSentencesAreCounted) {
  NmeaFixes fixes;
  EXPECT_TRUE(add(fixes, gga("10x500.00"), "2026-11-25T10:15:00.10Z").empty());
  EXPECT_EQ(fixes.counters().malformed, 1u);
}

}  // namespace
}  // namespace fleetmap::sensor
