#include "fleetmap/sensor/ground_plane.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace fleetmap::sensor {
namespace {

constexpr double kNearest = 1.5, kFarthest = 12.0;  // m: the robot itself; ground bends
constexpr std::size_t kMaxPoints = 1500, kMinPoints = 200;
constexpr int kTries = 100;
constexpr double kThickness = 0.12;    // m on either side
constexpr double kBelow = 0.35;        // m under a plane that is not the ground
constexpr double kShareOfPlane = 0.2;  // of the points, at least
constexpr double kShareBelow = 0.03;   // at most
const double kMinUp = std::cos(0.25 * M_PI);

using Points = std::vector<Eigen::Vector3d>;

/// In base_link, thinned evenly.
Points near_points(const Scan& scan, const Pose& T_base_lidar) {
  Points near;
  for (const ScanPoint& point : scan.points) {
    const Eigen::Vector3d p = T_base_lidar * point.position.cast<double>();
    const double range = p.head<2>().norm();
    if (range >= kNearest && range <= kFarthest) near.push_back(p);
  }
  if (near.size() <= kMaxPoints) return near;
  Points thinned;
  for (std::size_t k = 0; k < kMaxPoints; ++k) thinned.push_back(near[k * near.size() / kMaxPoints]);
  return thinned;
}

struct Plane {
  Eigen::Vector3d normal;
  double offset = 0.0;
  double height_of(const Eigen::Vector3d& p) const { return normal.dot(p) - offset; }
};

/// Points on the plane; 0 if too many are below it.
std::size_t support(const Plane& plane, const Points& points) {
  std::size_t on = 0, below = 0;
  for (const Eigen::Vector3d& p : points) {
    const double height = plane.height_of(p);
    on += std::abs(height) < kThickness ? 1 : 0;
    below += height < -kBelow ? 1 : 0;
  }
  return static_cast<double>(below) > kShareBelow * static_cast<double>(points.size()) ? 0 : on;
}

/// The normal of the points on the plane by least squares.
Eigen::Vector3d refined(const Plane& plane, const Points& points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  double count = 0.0;
  for (const Eigen::Vector3d& p : points) {
    if (std::abs(plane.height_of(p)) >= kThickness) continue;
    mean += p;
    squares += p * p.transpose();
    count += 1.0;
  }
  mean /= count;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(squares / count - mean * mean.transpose());
  const Eigen::Vector3d normal = solver.eigenvectors().col(0);
  return normal.z() < 0.0 ? Eigen::Vector3d(-normal) : normal;
}

}  // namespace

std::optional<Eigen::Vector3d> ground_normal(const Scan& scan, const Pose& T_base_lidar) {
  const Points points = near_points(scan, T_base_lidar);
  if (points.size() < kMinPoints) return std::nullopt;
  std::mt19937 random(1);
  Plane best{Eigen::Vector3d::UnitZ()};
  std::size_t max_inliers = 0;
  for (int k = 0; k < kTries; ++k) {
    const Eigen::Vector3d &a = points[random() % points.size()], &b = points[random() % points.size()],
                          &c = points[random() % points.size()];
    Eigen::Vector3d normal = (b - a).cross(c - a);
    if (normal.norm() < 1.0) continue;  // three points nearly on a line
    normal *= (normal.z() < 0.0 ? -1.0 : 1.0) / normal.norm();
    if (normal.z() < kMinUp) continue;
    const Plane plane{normal, normal.dot(a)};
    const std::size_t on = support(plane, points);
    if (on > max_inliers) {
      max_inliers = on;
      best = plane;
    }
  }
  if (static_cast<double>(max_inliers) < kShareOfPlane * static_cast<double>(points.size()))
    return std::nullopt;
  return refined(best, points);
}

}  // namespace fleetmap::sensor
