#include "fleetmap/sensor/gps_agreement.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <random>

#include "sensor/stamps.hpp"

namespace fleetmap::sensor {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// 80 m with turns to either side, GPS with 1.5 m of slow error; `spoil` gets the seconds since the start.
std::vector<std::string> findings(const std::function<void(double, GeoPoint&)>& spoil) {
  const LocalFrame site(geo_point_from_degrees(48.2, 11.6, 500.0));
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  Eigen::Vector2d error(1.0, -1.0);
  GpsAgreement agreement;
  Pose T = Pose::Identity();
  for (int k = 0; k < 800; ++k) {
    const double t = 0.1 * k;
    if (k % 2 == 0) {
      error = 0.997 * error + 0.12 * Eigen::Vector2d(normal(random), normal(random));
      Fix fix;
      fix.stamp = at(t);
      const Eigen::Vector3d p = rotation_from_rpy(0.0, 0.0, 1.0) * T.translation();
      fix.position = site.to_geo(p + Eigen::Vector3d(error.x(), error.y(), 0.0));
      fix.covariance = 2.25 * Eigen::Matrix3d::Identity();
      spoil(t, fix.position);
      agreement.add(fix);
    }
    agreement.add_motion(at(t), T);
    T = T * make_pose(rotation_from_rpy(0.0, 0.0, 0.03 * std::sin(0.05 * t)), Eigen::Vector3d(0.1, 0.0, 0.0));
  }
  return agreement.take_findings();
}

TEST(GpsAgreement, IsSilentForAGpsWithSlowErrors) {
  EXPECT_THAT(findings([](double, GeoPoint&) {}), IsEmpty());
}

TEST(GpsAgreement, SwappedCoordinatesAreNamed) {
  EXPECT_THAT(findings([](double, GeoPoint& p) { std::swap(p.latitude, p.longitude); }),
              ElementsAre(HasSubstr("latitude and longitude are swapped")));
  EXPECT_THAT(findings([](double, GeoPoint& p) { p.longitude = -p.longitude; }),
              ElementsAre(HasSubstr("mirrored")));
}

TEST(GpsAgreement, AJumpIsNamedOnce) {
  EXPECT_THAT(findings([](double t, GeoPoint& p) { p.latitude += t > 30.0 ? 50.0 / 6'371'000.0 : 0.0; }),
              ::testing::Contains(HasSubstr("GPS: it jumped by")));
}

TEST(GpsAgreement, AStepOfItsHeightIsNamed) {
  EXPECT_THAT(findings([](double t, GeoPoint& p) { p.altitude += t > 30.0 ? 40.0 : 0.0; }),
              ElementsAre(HasSubstr("GPS: its height jumped by 40 m")));
}

TEST(GpsAgreement, OneThatStandsIsNamed) {
  EXPECT_THAT(findings([](double, GeoPoint& p) { p = geo_point_from_degrees(48.2, 11.6, 500.0); }),
              ElementsAre(HasSubstr("misses the way")));
}

}  // namespace
}  // namespace fleetmap::sensor
