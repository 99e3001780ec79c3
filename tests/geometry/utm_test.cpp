#include "fleetmap/geometry/utm.hpp"

#include <gtest/gtest.h>

#include <GeographicLib/UTMUPS.hpp>
#include <limits>
#include <random>
#include <set>

namespace fleetmap {
namespace {

TEST(UtmZone, OfAPlaceIsTheStandardOne) {
  const auto epsg = [](double latitude, double longitude) {
    const auto zone = utm_zone_at(geo_point_from_degrees(latitude, longitude, 0.0));
    return zone ? zone->epsg() : 0;
  };
  EXPECT_EQ(epsg(39.0, -3.0), 32630);
  EXPECT_EQ(epsg(-33.0, 18.0), 32734);
  EXPECT_EQ(epsg(0.0, -180.0), 32601);
  EXPECT_EQ(epsg(10.0, 179.99), 32660);
  EXPECT_EQ(epsg(60.0, 4.0), 32632) << "Norway";
  EXPECT_EQ(epsg(78.0, 8.0), 32631) << "Svalbard";
  EXPECT_EQ(epsg(84.5, 0.0), 0) << "polar";
  EXPECT_EQ(epsg(-80.5, 0.0), 0) << "polar";
  EXPECT_EQ(epsg(std::numeric_limits<double>::quiet_NaN(), 0.0), 0);
}

TEST(UtmZone, CodesAreThoseOfItsZones) {
  std::set<int> codes;
  for (int code = 32'500; code < 32'900; ++code) {
    const auto zone = utm_zone_of_epsg(code);
    if (!zone) continue;
    EXPECT_EQ(zone->epsg(), code);
    codes.insert(code);
  }
  EXPECT_EQ(codes.size(), 120u);
  EXPECT_TRUE(codes.contains(32601) && codes.contains(32660) && codes.contains(32701) &&
              codes.contains(32760));
  for (const int code : {-1, 0, 4326, 25830, 32661, 32761}) EXPECT_FALSE(utm_zone_of_epsg(code)) << code;
}

TEST(Utm, AgreesWithGeographicLibsUtmInEachZone) {
  std::mt19937 random(5);
  const auto draw = [&random](double from, double to) {
    return std::uniform_real_distribution(from, to)(random);
  };
  for (int k = 0; k < 5000; ++k) {
    const double latitude = draw(-79.9, 83.9), longitude = draw(-180.0, 180.0);
    const GeoPoint point = geo_point_from_degrees(latitude, longitude, 0.0);
    const auto zone = utm_zone_at(point);
    ASSERT_TRUE(zone);
    int number = 0;
    bool north = false;
    double x = 0.0, y = 0.0, convergence = 0.0, scale = 0.0;
    GeographicLib::UTMUPS::Forward(latitude, longitude, number, north, x, y, convergence, scale);
    ASSERT_EQ(*zone, (UtmZone{number, north}));
    const auto utm = to_utm(point, *zone);
    ASSERT_TRUE(utm);
    EXPECT_LT((utm->p_utm - Eigen::Vector2d(x, y)).norm(), 1e-7);
    EXPECT_NEAR(utm->scale, scale, 1e-12);
  }
}

TEST(Utm, ReachesIntoOtherZonesAndEndsFarFromThem) {
  const UtmZone zone30{30, true};
  const auto at = [&](double longitude) {
    return to_utm(geo_point_from_degrees(40.0, longitude, 0.0), zone30);
  };
  // On the border of two zones both have it, mirrored at their middles.
  const auto here = at(0.0), there = to_utm(geo_point_from_degrees(40.0, 0.0, 0.0), {31, true});
  ASSERT_TRUE(here && there);
  EXPECT_NEAR(here->p_utm.x() - kUtmFalseEasting, kUtmFalseEasting - there->p_utm.x(), 1e-6);
  EXPECT_NEAR(here->p_utm.y(), there->p_utm.y(), 1e-6);
  EXPECT_TRUE(at(26.9));
  EXPECT_FALSE(at(27.1));
  EXPECT_FALSE(at(177.0));
  EXPECT_TRUE(to_utm(geo_point_from_degrees(0.0, 179.0, 0.0), {1, true})) << "across the antimeridian";
  const auto south = to_utm(geo_point_from_degrees(-1e-6, -3.0, 0.0), {30, false});
  ASSERT_TRUE(south);
  EXPECT_NEAR(south->p_utm.y(), 10'000'000.0, 0.2);
  EXPECT_FALSE(to_utm({std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}, zone30));
}

}  // namespace
}  // namespace fleetmap
