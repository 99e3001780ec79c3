#include "fleetmap/output/map_crs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <GeographicLib/LocalCartesian.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

#include "geometry/geoid_file.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::output {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using Kind = CrsRequest::Kind;

const MapPlace kSpain{geo_point_from_degrees(39.0, -0.02, 600.0), true};  // 1.7 km west of zone 31
const MapPlace kNowhere{{}, false};

TEST(ParseCrs, ReadsWhatIsOfferedInAnyCase) {
  EXPECT_EQ(*parse_crs("utm"), CrsRequest{});
  EXPECT_EQ(parse_crs("ENU")->kind, Kind::enu);
  EXPECT_EQ(*parse_crs("EPSG:32733"), (CrsRequest{Kind::zone, {33, false}}));
  EXPECT_EQ(*parse_crs("epsg:32601"), (CrsRequest{Kind::zone, {1, true}}));
}

TEST(ParseCrs, RefusesTheRestWithWhatIsOffered) {
  for (const char* wrong : {"", "EPSG:", "EPSG:25830", "EPSG:4326", "EPSG:32600", "EPSG:32630x", "EPSG:-1",
                            "EPSG:99999999999999", "32630", "wgs84"}) {
    const auto request = parse_crs(wrong);
    ASSERT_FALSE(request) << wrong;
    EXPECT_THAT(request.error().message, AllOf(HasSubstr(wrong), HasSubstr("EPSG:32601"), HasSubstr("enu")));
  }
}

TEST(MapCrs, DefaultIsTheZoneOfTheOrigin) {
  const auto crs = MapCrs::of({}, kSpain, std::nullopt);
  ASSERT_TRUE(crs) << crs.error().message;
  EXPECT_EQ(crs->name(), "EPSG:32630");
  EXPECT_THAT(crs->wkt(), HasSubstr("32630"));
  EXPECT_THAT(crs->text(), AllOf(HasSubstr("EPSG:32630"), HasSubstr("above the WGS 84 ellipsoid")));
  EXPECT_NEAR(crs->scale(), 1.0004, 2e-4);
  EXPECT_EQ(crs->offset(), Eigen::Vector3i(758'000, 4'321'000, 0));
}

/// Easting, northing and ellipsoidal height by GeographicLib alone.
Eigen::Vector3d expected(const GeoPoint& origin, int zone, const Eigen::Vector3f& p) {
  constexpr double kDegree = 0.017453292519943295;
  double latitude = 0.0, longitude = 0.0, height = 0.0, x = 0.0, y = 0.0;
  GeographicLib::LocalCartesian(origin.latitude / kDegree, origin.longitude / kDegree, origin.altitude)
      .Reverse(static_cast<double>(p.x()), static_cast<double>(p.y()), static_cast<double>(p.z()), latitude,
               longitude, height);
  bool north = false;
  GeographicLib::UTMUPS::Forward(latitude, longitude, zone, north, x, y, zone);
  return {x, y, height};
}

TEST(MapCrs, AgreesWithGeographicLibInTheOwnAndTheNeighbouringZone) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> metres(-5'000.0f, 5'000.0f);
  std::vector<Eigen::Vector3f> points;
  for (int k = 0; k < 2'000; ++k) points.emplace_back(metres(random), metres(random), 0.02f * metres(random));
  for (const int zone : {30, 31}) {
    const auto crs = MapCrs::of({Kind::zone, {zone, true}}, kSpain, std::nullopt);
    ASSERT_TRUE(crs);
    const auto coordinates = crs->from_map(points);
    ASSERT_TRUE(coordinates);
    ASSERT_EQ(coordinates->size(), points.size());
    for (std::size_t k = 0; k < points.size(); ++k)
      EXPECT_LT(((*coordinates)[k] - expected(kSpain.origin, zone, points[k])).norm(), 1e-6);
  }
}

TEST(MapCrs, HeightsAreAboveTheGeoidThatIsGiven) {
  const testing::TemporaryFolder folder;
  testing::write_sloped_geoid(folder.path(), "slope");
  setenv("GEOGRAPHICLIB_GEOID_PATH", folder.path().c_str(), 1);
  const auto geoid = Geoid::load("slope");
  unsetenv("GEOGRAPHICLIB_GEOID_PATH");
  ASSERT_TRUE(geoid) << geoid.error().message;
  const auto crs = MapCrs::of({}, kSpain, *geoid);
  ASSERT_TRUE(crs);
  const auto coordinates = crs->from_map(std::vector{Eigen::Vector3f(0.0f, 0.0f, 2.0f)});
  ASSERT_TRUE(coordinates);
  EXPECT_NEAR(coordinates->front().z(), 602.0 - 3.9, 1e-6) << "0.1 m for each degree of latitude";
  EXPECT_THAT(crs->wkt(), HasSubstr("slope height"));
  EXPECT_THAT(crs->text(), HasSubstr("above the geoid slope"));
  EXPECT_THAT(MapCrs::of({Kind::enu, {}}, kSpain, *geoid).error().message, HasSubstr("--geoid"));
}

TEST(MapCrs, EnuIsTheFrameOfTheMapAndNamesItsOrigin) {
  const auto crs = MapCrs::of({Kind::enu, {}}, kSpain, std::nullopt);
  ASSERT_TRUE(crs);
  const auto coordinates = crs->from_map(std::vector{Eigen::Vector3f(1.0f, -2.0f, 3.0f)});
  EXPECT_EQ(coordinates->front(), Eigen::Vector3d(1.0, -2.0, 3.0));
  EXPECT_EQ(crs->name(), "enu");
  EXPECT_EQ(crs->offset(), Eigen::Vector3i::Zero());
  EXPECT_THAT(crs->text(), HasSubstr("39.000000000, -0.020000000 deg"));
}

TEST(MapCrs, AMapWithoutAPlaceHasOnlyItsOwnFrame) {
  for (const CrsRequest& request : {CrsRequest{}, CrsRequest{Kind::zone, {31, true}}}) {
    const auto crs = MapCrs::of(request, kNowhere, std::nullopt);
    ASSERT_FALSE(crs);
    EXPECT_THAT(crs.error().message, AllOf(HasSubstr("GPS"), HasSubstr("--crs enu")));
  }
  const auto crs = MapCrs::of({Kind::enu, {}}, kNowhere, std::nullopt);
  ASSERT_TRUE(crs);
  EXPECT_THAT(crs->text(), HasSubstr("Nobody knows its place"));
  EXPECT_THAT(crs->wkt(), HasSubstr("unknown"));
}

TEST(MapCrs, RefusesZonesThatAreFarAwayOrWhereThereAreNone) {
  const auto far = MapCrs::of({Kind::zone, {60, true}}, kSpain, std::nullopt);
  ASSERT_FALSE(far);
  EXPECT_THAT(far.error().message, AllOf(HasSubstr("EPSG:32660"), HasSubstr("177"), HasSubstr("EPSG:32630")));
  const auto polar = MapCrs::of({}, {geo_point_from_degrees(88.0, 0.0, 0.0), true}, std::nullopt);
  ASSERT_FALSE(polar);
  EXPECT_THAT(polar.error().message, AllOf(HasSubstr("88"), HasSubstr("--crs enu")));
}

TEST(MapCrs, APointThatIsNoneHasNoCoordinates) {
  const auto crs = MapCrs::of({}, kSpain, std::nullopt);
  ASSERT_TRUE(crs);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto coordinates =
      crs->from_map(std::vector{Eigen::Vector3f(nan, 0.0f, 0.0f), Eigen::Vector3f(1e30f, 0.0f, 0.0f)});
  ASSERT_TRUE(coordinates);
  EXPECT_FALSE(coordinates->front().allFinite());
  const Eigen::Vector3d& far = coordinates->back();
  EXPECT_TRUE(!far.allFinite() || std::abs(far.z()) > 1e9);
}

TEST(MapCrs, RobotsWhoseHeightsMayBeOfAnotherKindAreNamed) {
  MapPlace place = kSpain;
  place.unknown = {AgentId::parse("r2").value(), AgentId::parse("r3").value()};
  for (const Kind kind : {Kind::site_zone, Kind::enu}) {
    const auto crs = MapCrs::of({kind, {}}, place, std::nullopt);
    ASSERT_TRUE(crs);
    EXPECT_THAT(crs->text(),
                AllOf(HasSubstr("above the WGS 84 ellipsoid"),
                      HasSubstr(" Heights at the nodes of r2, r3 are as GPS gave them there: ")));
  }
}

TEST(MapCrs, HeightsAboveSeaLevelAreNoEllipsoidalOnesAndTakeNoGeoid) {
  MapPlace place = kSpain;
  place.above_sea_level = true;
  const auto crs = MapCrs::of({}, place, std::nullopt);
  ASSERT_TRUE(crs);
  EXPECT_THAT(crs->text(), HasSubstr("Heights: metres above mean sea level as GPS gave them."));
  EXPECT_THAT(crs->wkt(), AllOf(HasSubstr("mean sea level"), Not(HasSubstr("llipsoid"))));
  const auto enu = MapCrs::of({Kind::enu, {}}, place, std::nullopt);
  ASSERT_TRUE(enu);
  EXPECT_THAT(enu->text() + enu->wkt(),
              AllOf(HasSubstr("600.000 m above mean sea level as GPS gave it"), Not(HasSubstr("llipsoid"))));
  const testing::TemporaryFolder folder;
  testing::write_sloped_geoid(folder.path(), "slope");
  setenv("GEOGRAPHICLIB_GEOID_PATH", folder.path().c_str(), 1);
  const auto geoid = Geoid::load("slope");
  unsetenv("GEOGRAPHICLIB_GEOID_PATH");
  ASSERT_TRUE(geoid);
  EXPECT_THAT(MapCrs::of({}, place, *geoid).error().message,
              AllOf(HasSubstr("gps.geoid"), HasSubstr("--geoid")));
}

}  // namespace
}  // namespace fleetmap::output
