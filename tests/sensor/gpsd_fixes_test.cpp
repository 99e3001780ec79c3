#include "fleetmap/sensor/gpsd_fixes.hpp"

#include <gmock/gmock.h>

#include "fleetmap/core/utc.hpp"
#include "fleetmap/geometry/degree.hpp"

namespace fleetmap::sensor {
namespace {

using ::testing::ElementsAre;

/// Reports of the manual page gpsd_json(5), with the line ends of the protocol.
constexpr std::string_view kGreeting =
    "{\"class\":\"VERSION\",\"release\":\"3.22\",\"rev\":\"3.22\",\"proto_major\":3,\"proto_minor\":14}\r\n";
constexpr std::string_view kTpv =
    "{\"class\":\"TPV\",\"device\":\"stdin\",\"time\":\"2010-04-30T11:48:20.10Z\",\"ept\":0.005,\"lat\":46."
    "498204497,"
    "\"lon\":7.568061439,\"alt\":1327.689,\"epx\":15.319,\"epy\":17.054,\"epv\":124.484,\"track\":10.3797,"
    "\"speed\":0.091,\"climb\":-0.085,\"eps\":34.11,\"mode\":3}\r\n";
constexpr std::string_view kSky =
    "{\"class\":\"SKY\",\"device\":\"/dev/pts/"
    "1\",\"time\":\"2005-07-08T11:28:07.11Z\",\"xdop\":1.55,\"hdop\":1.24,"
    "\"pdop\":1.99,\"satellites\":[{\"PRN\":23,\"el\":6,\"az\":84,\"ss\":0,\"used\":false}]}\r\n";

TEST(GpsdFixes, ReportsOfTheManualPage) {
  GpsdFixes fixes;
  const auto found =
      fixes.add(bytes_of(std::string(kGreeting) + std::string(kTpv) + std::string(kSky))).fixes;
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(to_utc(found[0].stamp), "2010-04-30T11:48:20.100Z");
  EXPECT_TRUE(found[0].valid);
  EXPECT_NEAR(found[0].position.latitude / kDegree, 46.498204497, 1e-12);
  EXPECT_NEAR(found[0].position.longitude / kDegree, 7.568061439, 1e-12);
  EXPECT_NEAR(found[0].position.altitude, 1327.689, 1e-9);
  EXPECT_NEAR(found[0].covariance(0, 0), 15.319 * 15.319, 1e-9);
  EXPECT_NEAR(found[0].covariance(1, 1), 17.054 * 17.054, 1e-9);
  EXPECT_NEAR(found[0].covariance(2, 2), 124.484 * 124.484, 1e-9);
  EXPECT_EQ(fixes.counters().reports, 3u);
  EXPECT_EQ(fixes.counters().malformed, 0u);
  EXPECT_EQ(fixes.counters().above_sea_level, 1u);
}

TEST(GpsdFixes, TheAltitudeAboveTheEllipsoidIsTaken) {
  GpsdFixes fixes;
  const auto found =
      fixes
          .add(bytes_of("{\"class\":\"TPV\",\"time\":\"2026-11-25T10:00:00Z\",\"lat\":1,\"lon\":2,"
                        "\"altMSL\":10.0,\"altHAE\":60.5,\"alt\":10.0,\"mode\":3}\n"))
          .fixes;
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].position.altitude, 60.5);
  EXPECT_TRUE(found[0].covariance.isZero(0.0)) << "not stated";
  EXPECT_EQ(fixes.counters().above_sea_level, 0u);
}

TEST(GpsdFixes, WithoutAnAltitudeOrAModeThereIsNoFix) {
  GpsdFixes fixes;
  for (const char* rest :
       {"\"mode\":1", "\"mode\":2,\"lat\":1,\"lon\":2", "\"mode\":2,\"lat\":1,\"lon\":2,\"alt\":3",
        "\"mode\":3,\"lat\":1,\"lon\":\"2\",\"alt\":3", "\"mode\":3,\"lat\":91,\"lon\":2,\"alt\":3"}) {
    const auto found = fixes
                           .add(bytes_of("{\"class\":\"TPV\",\"time\":\"2026-11-25T10:00:00Z\"," +
                                         std::string(rest) + "}\n"))
                           .fixes;
    ASSERT_EQ(found.size(), 1u);
    EXPECT_FALSE(found[0].valid) << rest;
  }
  EXPECT_TRUE(fixes.add(bytes_of("{\"class\":\"TPV\",\"mode\":1}\n")).fixes.empty());
  EXPECT_EQ(fixes.counters().without_time, 1u);
}

TEST(GpsdFixes, LinesComeInPiecesAndDamagedOnesCostThemselvesAlone) {
  const std::string whole = std::string(kGreeting) + std::string(kTpv);
  for (std::size_t at = 0; at + 1 < kGreeting.size(); ++at) {
    std::string damaged = whole;
    damaged.erase(at, 1);
    GpsdFixes fixes;
    std::size_t found = 0;
    for (const char byte : damaged) found += fixes.add(bytes_of({&byte, 1})).fixes.size();
    EXPECT_EQ(found, 1u) << at;
  }
}

TEST(GpsdFixes, ANewConnectionBeginsWithALine) {
  GpsdFixes fixes;
  fixes.add(bytes_of(kTpv.substr(0, 40)));
  fixes.begin();
  EXPECT_EQ(fixes.add(bytes_of(kTpv)).fixes.size(), 1u);
  EXPECT_EQ(fixes.counters().malformed, 0u);
}

TEST(GpsdFixes, ALineWithoutEndIsBounded) {
  GpsdFixes fixes;
  EXPECT_TRUE(fixes.add(Bytes(1 << 20, '[')).fixes.empty());
  EXPECT_EQ(fixes.counters().malformed, 1u);
  EXPECT_EQ(fixes.add(bytes_of("\n" + std::string(kTpv))).fixes.size(), 1u);
}

TEST(GpsdFixes, ErrorsOfGpsdAreHandedOn) {
  GpsdFixes fixes;
  fixes.add(bytes_of("{\"class\":\"ERROR\",\"message\":\"Can't open /dev/ttyUSB0\"}\n[1]\n"));
  EXPECT_THAT(fixes.take_errors(), ElementsAre("Can't open /dev/ttyUSB0"));
  EXPECT_TRUE(fixes.take_errors().empty());
  EXPECT_EQ(fixes.counters().malformed, 1u);
}

}  // namespace
}  // namespace fleetmap::sensor
