#include "fleetmap/sensor/nmea_sentences.hpp"

#include <gmock/gmock.h>

#include "fleetmap/core/utc.hpp"
#include "fleetmap/geometry/degree.hpp"

namespace fleetmap::sensor {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;

/// Examples of receivers' manuals, checksums as printed there.
constexpr std::string_view kGga = "$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47\r\n";
constexpr std::string_view kRmc = "$GPRMC,123519,A,4807.038,N,01131.000,E,022.4,084.4,230394,003.1,W*6A\r\n";
constexpr std::string_view kGst = "$GPGST,172814.0,0.006,0.023,0.020,273.6,0.023,0.020,0.031*6A\r\n";

std::string body(std::string_view sentence) {
  return std::string(sentence.substr(1, sentence.rfind('*') - 1));
}

template <class T>
T read(std::string_view sentence) {
  const auto found = read_nmea(body(sentence));
  EXPECT_TRUE(found && std::holds_alternative<T>(*found));
  return found && std::holds_alternative<T>(*found) ? std::get<T>(*found) : T{};
}

TEST(NmeaSentences, FindsThoseOfManuals) {
  NmeaSentences sentences;
  const std::string stream = "038,N*00\r\n" + std::string(kGga) + std::string(kRmc) + std::string(kGst);
  EXPECT_THAT(sentences.add(bytes_of(stream)), ElementsAre(body(kGga), body(kRmc), body(kGst)));
  EXPECT_EQ(sentences.counters().sentences, 3u);
  EXPECT_EQ(sentences.counters().wrong_checksums, 0u);
}

TEST(NmeaSentences, BytesOneByOneAreTheSameStream) {
  NmeaSentences sentences;
  std::vector<std::string> found;
  for (const char byte : std::string(kGga) + std::string(kRmc)) {
    for (std::string& text : sentences.add(bytes_of({&byte, 1}))) found.push_back(std::move(text));
  }
  EXPECT_THAT(found, ElementsAre(body(kGga), body(kRmc)));
}

TEST(NmeaSentences, AFlippedBitCostsItsSentenceAlone) {
  const std::string whole = std::string(kRmc) + std::string(kGga) + std::string(kGst);
  for (std::size_t bit = 0; bit < 8 * kGga.size(); ++bit) {
    std::string damaged = whole;
    const std::size_t at = kRmc.size() + bit / 8;
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << bit % 8));
    NmeaSentences sentences;
    const auto found = sentences.add(bytes_of(damaged));
    // The case of a digit of the checksum says nothing, and either end of the line suffices.
    if (found.size() == 3 && bit / 8 >= kGga.size() - 4) continue;
    // A line whose end is lost takes the one behind it along.
    EXPECT_THAT(found, ElementsAre(body(kRmc), body(kGst))) << "bit " << bit;
  }
}

TEST(NmeaSentences, ACutSentenceCostsItselfAlone) {
  for (std::size_t left = 1; left < kGga.size() - 2; ++left) {
    NmeaSentences sentences;
    EXPECT_THAT(sentences.add(bytes_of(std::string(kGga.substr(0, left)) + std::string(kRmc))),
                ElementsAre(body(kRmc)));
    EXPECT_EQ(sentences.counters().cut, 1u) << left;
  }
}

TEST(NmeaSentences, ALineWithoutEndIsLeft) {
  NmeaSentences sentences;
  EXPECT_TRUE(sentences.add(Bytes(1000, 'A')).empty());
  EXPECT_TRUE(sentences.add(bytes_of("$" + std::string(1000, 'A'))).empty());
  EXPECT_EQ(sentences.counters().cut, 1u);
  EXPECT_THAT(sentences.add(bytes_of(kGst)), ElementsAre(body(kGst)));
}

TEST(NmeaSentences, Gga) {
  const NmeaGga gga = read<NmeaGga>(kGga);
  EXPECT_EQ(gga.time, 12h + 35min + 19s);
  EXPECT_EQ(gga.quality, 1);
  EXPECT_NEAR(gga.position.latitude / kDegree, 48.1173, 1e-9);
  EXPECT_NEAR(gga.position.longitude / kDegree, 11.0 + 31.0 / 60.0, 1e-9);
  EXPECT_NEAR(gga.position.altitude, 545.4 + 46.9, 1e-9) << "above the ellipsoid";
}

TEST(NmeaSentences, SouthAndWestAreNegative) {
  const NmeaGga gga = read<NmeaGga>("$GNGGA,000000.50,3354.6000,S,07040.2000,W,4,12,0.6,500.0,M,,M,,*00");
  EXPECT_NEAR(gga.position.latitude / kDegree, -33.91, 1e-9);
  EXPECT_NEAR(gga.position.longitude / kDegree, -70.67, 1e-9);
  EXPECT_EQ(gga.time, 500ms);
  EXPECT_FALSE(gga.has_geoid);
}

TEST(NmeaSentences, Rmc) {
  const NmeaRmc rmc = read<NmeaRmc>(kRmc);
  EXPECT_TRUE(rmc.valid);
  EXPECT_EQ(rmc.time, 12h + 35min + 19s);
  EXPECT_EQ(to_utc(rmc.midnight), "1994-03-23T00:00:00.000Z");
}

TEST(NmeaSentences, Gst) {
  const NmeaGst gst = read<NmeaGst>(kGst);
  EXPECT_EQ(gst.time, 17h + 28min + 14s);
  EXPECT_EQ(gst.sigma_north, 0.023);
  EXPECT_EQ(gst.sigma_east, 0.020);
  EXPECT_EQ(gst.sigma_up, 0.031);
}

TEST(NmeaSentences, WithoutAFixThereIsNone) {
  EXPECT_EQ(read<NmeaGga>("$GPGGA,101010.00,,,,,0,00,99.99,,,,,,*00").quality, 0);
  read<NmeaOther>("$GPGGA,,,,,,0,00,99.99,,,,,,*00");
  read<NmeaOther>("$GPRMC,,V,,,,,,,,,,N*00");
  read<NmeaOther>("$GPGSV,3,1,11,03,03,111,00*00");
}

TEST(NmeaSentences, FieldsThatAreNoneMakeTheSentenceMalformed) {
  for (const char* text : {"GPGGA,1235x9,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,",
                           "GPGGA,243519,4807.038,N,01131.000,E,1,,,1,M,,",
                           "GPGGA,123519,4867.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,",
                           "GPGGA,123519,4807.038,Q,01131.000,E,1,,,1,M,,",
                           "GPGGA,123519,4807.038,N,01131.000,,1,08,0.9,545.4,M,46.9,M,,",
                           "GPGGA,123519,4807.038,N,01131.000,E,1,,,nan,M,,",
                           "GPRMC,123519,A,4807.038,N,01131.000,E,022.4,084.4,310294,,",
                           "GPRMC,123519,A,,,,,,,-10394,,", "GPRMC,1,A,,,,,,,,,"})
    EXPECT_FALSE(read_nmea(text)) << text;
}

}  // namespace
}  // namespace fleetmap::sensor
