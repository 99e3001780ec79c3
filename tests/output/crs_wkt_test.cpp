#include "crs_wkt.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "support/process.hpp"

namespace fleetmap::output {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

const UtmZone kNorth{30, true}, kSouth{1, false};
const GeoPoint kOrigin = geo_point_from_degrees(39.0, -3.0, 600.0);

std::vector<std::string> each_wkt() {
  return {utm_wkt(kNorth, std::nullopt), utm_wkt(kSouth, "egm96-5"), utm_wkt(kNorth, "egm2008-1"),
          utm_wkt(kNorth, "mine"),       local_wkt(kOrigin),         local_wkt(std::nullopt)};
}

TEST(CrsWkt, IsBalanced) {
  for (const std::string& wkt : each_wkt()) {
    EXPECT_EQ(std::ranges::count(wkt, '['), std::ranges::count(wkt, ']')) << wkt;
    EXPECT_EQ(std::ranges::count(wkt, '"') % 2, 0) << wkt;
    EXPECT_TRUE(std::ranges::all_of(wkt, [](char c) { return c >= ' ' && c <= '~'; })) << wkt;
  }
}

TEST(CrsWkt, NamesTheZoneAndWhatHeightsAreAbove) {
  const std::string north = utm_wkt(kNorth, std::nullopt), south = utm_wkt(kSouth, "egm96-5");
  EXPECT_THAT(north, StartsWith("COMPD_CS[\"WGS 84 / UTM zone 30N + Ellipsoid (metre)\",PROJCS["));
  EXPECT_THAT(north, HasSubstr("PARAMETER[\"central_meridian\",-3]"));
  EXPECT_THAT(north, HasSubstr("PARAMETER[\"false_northing\",0]"));
  EXPECT_THAT(north, HasSubstr("AUTHORITY[\"EPSG\",\"32630\"]]"));
  EXPECT_THAT(north, HasSubstr("VERT_DATUM[\"Ellipsoid\",2002]"));
  EXPECT_THAT(south, HasSubstr("WGS 84 / UTM zone 1S"));
  EXPECT_THAT(south, HasSubstr("PARAMETER[\"central_meridian\",-177]"));
  EXPECT_THAT(south, HasSubstr("PARAMETER[\"false_northing\",10000000]"));
  EXPECT_THAT(south, HasSubstr("AUTHORITY[\"EPSG\",\"32701\"]]"));
  EXPECT_THAT(south, HasSubstr("VERT_CS[\"EGM96 height\""));
  EXPECT_THAT(south, HasSubstr("AUTHORITY[\"EPSG\",\"5773\"]"));
  EXPECT_THAT(utm_wkt(kNorth, "mine"), HasSubstr("VERT_CS[\"mine height\",VERT_DATUM[\"mine\",2005],"));
}

TEST(CrsWkt, OfALocalFrameNamesItsOriginOrThatThereIsNone) {
  EXPECT_THAT(local_wkt(kOrigin),
              StartsWith("LOCAL_CS[\"East-north-up frame at 39.000000000, -3.000000000 deg, "
                         "600.000 m above the WGS 84 ellipsoid\""));
  EXPECT_THAT(local_wkt(kOrigin), HasSubstr("AXIS[\"East\",EAST],AXIS[\"North\",NORTH]]"));
  const std::string nowhere = local_wkt(std::nullopt);
  EXPECT_THAT(nowhere, HasSubstr("unknown"));
  EXPECT_THAT(nowhere, Not(HasSubstr("EAST")));
}

/// Reading of a text by GDAL's gdalsrsinfo (gdal-bin); empty where it is not installed.
std::string gdal_reads(const std::string& wkt) {
  constexpr const char* kProgram = "/usr/bin/gdalsrsinfo";
  if (access(kProgram, X_OK) != 0) return {};
  testing::Process process({kProgram, "-V", "-o", "wkt2_2018", "--single-line", wkt});
  EXPECT_EQ(process.wait(), 0) << process.output();
  return process.output();
}

TEST(CrsWkt, GdalReadsWhatIsMeant) {
  if (gdal_reads(local_wkt(kOrigin)).empty()) GTEST_SKIP() << "gdalsrsinfo is not installed";
  for (const std::string& wkt : each_wkt())
    EXPECT_THAT(gdal_reads(wkt), HasSubstr("Validate Succeeds")) << wkt;
  const std::string ellipsoidal = gdal_reads(utm_wkt(kNorth, std::nullopt));
  EXPECT_THAT(ellipsoidal, HasSubstr("PROJCRS[\"WGS 84 / UTM zone 30N"));
  EXPECT_THAT(ellipsoidal, HasSubstr("ellipsoidal height (h)")) << "one system of three dimensions";
  EXPECT_THAT(gdal_reads(utm_wkt(kNorth, "egm2008-1")), HasSubstr("VERTCRS[\"EGM2008 height\""));
  EXPECT_THAT(gdal_reads(local_wkt(kOrigin)), HasSubstr("ENGCRS[\"East-north-up frame at 39"));
}

}  // namespace
}  // namespace fleetmap::output
