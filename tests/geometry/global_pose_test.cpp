#include "fleetmap/geometry/global_pose.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace fleetmap {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

GlobalPose pose_at(const GeoPoint& position, const Eigen::Matrix3d& R_enu_base) {
  GlobalPose G;
  G.position = position;
  G.q_enu_base = Eigen::Quaterniond(R_enu_base);
  return G;
}

TEST(GlobalPose, AtTheOriginIsItsRotation) {
  const GeoPoint origin = geo_point_from_degrees(48.0, 11.0, 500.0);
  const Eigen::Matrix3d R = rotation_from_rpy(0.1, -0.2, 2.5);
  const Pose T = pose_in(LocalFrame(origin), pose_at(origin, R));
  EXPECT_LT(T.translation().norm(), 1e-8);
  EXPECT_LT((T.linear() - R).norm(), 1e-12);
}

/// A point before the robot is there in every frame: it goes from base_link to the axes at the robot, to
/// the Earth, to the site.
TEST(GlobalPose, TakesPointsOfTheRobotToWhereTheyAreOnEarth) {
  const LocalFrame site(geo_point_from_degrees(60.0, 20.0, 30.0));
  for (const double longitude : {20.0, 20.2, 21.0, 19.0}) {
    const GlobalPose G =
        pose_at(geo_point_from_degrees(60.3, longitude, 80.0), rotation_from_rpy(0.05, 0.1, -1.2));
    const Pose T_site_base = pose_in(site, G);
    for (const Eigen::Vector3d& p : {Eigen::Vector3d(100.0, 0.0, 0.0), Eigen::Vector3d(-3.0, 40.0, 2.0)}) {
      const GeoPoint on_earth = LocalFrame(G.position).to_geo(G.q_enu_base * p);
      EXPECT_LT((T_site_base * p - site.to_enu(on_earth)).norm(), 1e-6) << longitude;
    }
  }
}

/// East of the origin a robot that faces north faces to the left of the site's north: meridians converge by
/// the difference of the longitudes times the sine of the latitude.
TEST(GlobalPose, NorthTurnsWithTheMeridians) {
  const LocalFrame site(geo_point_from_degrees(60.0, 20.0, 0.0));
  const Eigen::Matrix3d facing_north = rotation_from_rpy(0.0, 0.0, 0.5 * std::numbers::pi);
  const Pose T = pose_in(site, pose_at(geo_point_from_degrees(60.0, 20.1, 0.0), facing_north));
  const double yaw = rpy_from_rotation(T.linear()).z();
  EXPECT_NEAR(yaw - 0.5 * std::numbers::pi, 0.1 * kDegree * std::sin(60.0 * kDegree), 1e-6);
}

}  // namespace
}  // namespace fleetmap
