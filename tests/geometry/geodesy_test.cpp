#include "fleetmap/geometry/geodesy.hpp"

#include <gtest/gtest.h>

#include <GeographicLib/LocalCartesian.hpp>
#include <algorithm>
#include <numbers>
#include <random>
#include <vector>

#include "fleetmap/geometry/global_pose.hpp"

namespace fleetmap {
namespace {

TEST(Haversine, KnownDistances) {
  const GeoPoint pole = geo_point_from_degrees(90, 0, 0);
  const GeoPoint same_pole = geo_point_from_degrees(90, 123, 0);
  const GeoPoint equator = geo_point_from_degrees(0, 0, 0);
  const GeoPoint antipode = geo_point_from_degrees(0, 180, 0);
  const double quarter = kMeanEarthRadius * std::numbers::pi / 2;
  EXPECT_NEAR(haversine_distance(pole, same_pole), 0.0, 1e-6);
  EXPECT_NEAR(haversine_distance(pole, equator), quarter, 1e-3);
  EXPECT_NEAR(haversine_distance(equator, antipode), 2 * quarter, 1e-3);
  EXPECT_NEAR(haversine_distance(geo_point_from_degrees(10, 179.9999995, 0),
                                 geo_point_from_degrees(10, -179.9999995, 0)),
              0.1095, 1e-3)
      << "across the antimeridian";
}

TEST(LocalFrame, RoundTripsWithinNanometresOverASite) {
  const LocalFrame site(geo_point_from_degrees(48.98, 8.39, 110.0));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> metres(-5000.0, 5000.0);
  for (int k = 0; k < 200; ++k) {
    const Eigen::Vector3d p(metres(random), metres(random), 0.01 * metres(random));
    EXPECT_LT((site.to_enu(site.to_geo(p)) - p).norm(), 1e-6);
  }
}

TEST(LocalFrame, AgreesWithGeographicLibEverywhere) {
  std::mt19937 random(3);
  const auto draw = [&random](double reach) { return std::uniform_real_distribution(-reach, reach)(random); };
  for (int k = 0; k < 1000; ++k) {
    const double latitude = k == 0 ? 90.0 : draw(90.0), longitude = k == 1 ? 180.0 : draw(180.0);
    const double altitude = draw(4000.0);
    const double there_latitude = std::clamp(latitude + draw(0.5), -90.0, 90.0);
    const double there_longitude =
        k % 10 == 0 ? draw(180.0) : std::clamp(longitude + draw(0.5), -180.0, 180.0);
    const double there_altitude = draw(4000.0);
    Eigen::Vector3d p;
    std::vector<double> axes(9);
    GeographicLib::LocalCartesian(latitude, longitude, altitude)
        .Forward(there_latitude, there_longitude, there_altitude, p.x(), p.y(), p.z(), axes);
    const LocalFrame frame(geo_point_from_degrees(latitude, longitude, altitude));
    const GeoPoint there = geo_point_from_degrees(there_latitude, there_longitude, there_altitude);
    EXPECT_LT((frame.to_enu(there) - p).norm(), 2e-8) << latitude << ' ' << longitude;
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(axes.data());
    EXPECT_LT((frame.R_enu_local(there) - R).norm(), 1e-14) << latitude << ' ' << longitude;
  }
}

TEST(LocalFrame, DistancesAgreeWithHaversineWithinTheFlattening) {
  const LocalFrame site(geo_point_from_degrees(-33.0, 18.0, 0.0));
  const GeoPoint p = site.to_geo({60.0, 80.0, 0.0});
  EXPECT_NEAR(haversine_distance(site.origin(), p), 100.0, 0.5);
}

TEST(LocalFrame, AxesTurnWithTheEarth) {
  const LocalFrame site(geo_point_from_degrees(45.0, 0.0, 0.0));
  EXPECT_TRUE(site.R_enu_local(site.origin()).isApprox(Eigen::Matrix3d::Identity(), 1e-12));
  const GeoPoint north = site.to_geo({0.0, 10000.0, 0.0});
  const Eigen::Vector3d up_there = site.R_enu_local(north) * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(up_there.y(), 10000.0 / 6367000.0, 1e-5)
      << "up leans north by the angle driven round the Earth";
}

TEST(GlobalPose, PoseInSiteFrame) {
  const LocalFrame site(geo_point_from_degrees(48.0, 8.0, 100.0));
  GlobalPose G;
  G.position = site.to_geo({10.0, -20.0, 3.0});
  G.q_enu_base = Eigen::Quaterniond(rotation_from_rpy(0.0, 0.0, 0.5));
  const Pose T = pose_in(site, G);
  EXPECT_TRUE(T.translation().isApprox(Eigen::Vector3d(10.0, -20.0, 3.0), 1e-6));
  EXPECT_NEAR(rpy_from_rotation(T.linear()).z(), 0.5, 1e-5);
}

TEST(GeoPoint, ValidityRefusesNanAndOutOfRange) {
  EXPECT_TRUE(is_valid(geo_point_from_degrees(-90, 180, 0)));
  EXPECT_FALSE(is_valid(geo_point_from_degrees(90.001, 0, 0)));
  EXPECT_FALSE(is_valid(geo_point_from_degrees(0, 180.1, 0)));
  EXPECT_FALSE(is_valid({std::nan(""), 0, 0}));
  EXPECT_FALSE(is_valid({0, 0, std::numeric_limits<double>::infinity()}));
}

}  // namespace
}  // namespace fleetmap
