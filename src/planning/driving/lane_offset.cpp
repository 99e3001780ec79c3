#include "driving/lane_offset.hpp"

#include <algorithm>
#include <cmath>

#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::planning {
namespace {

constexpr double kLaneReach = 3.0;      // m to each side in which the borders of a lane are searched
constexpr double kTimeConstant = 5.0;   // s, in which a lane corrects the position across it
constexpr double kMemory = 180.0;       // s, over which the correction decays
constexpr double kMaxOffCourse = 0.35;  // rad between robot and path, beyond which the scan is not used

}  // namespace

void LaneOffset::update(const PathProgress& path, const LocalField& field, const Pose2& pose, double dt) {
  offset_ *= std::exp(-dt / kMemory);
  const Eigen::Vector2d tangent = path.tangent(path.along());
  const double off_course = wrap_angle(std::atan2(tangent.y(), tangent.x()) - pose.yaw);
  if (std::abs(off_course) > kMaxOffCourse) return;
  const Eigen::Vector2d left_base(-std::sin(off_course), std::cos(off_course));
  const auto border = [&](double sign) {
    double away = 0.0;
    while (away < kLaneReach && field.clearance(sign * away * left_base) > 0.15) away += 0.1;
    return away;
  };
  const double left = border(1.0);
  const double right = border(-1.0);
  if (left >= kLaneReach || right >= kLaneReach) return;
  const Eigen::Vector2d normal(-tangent.y(), tangent.x());
  const double beside = normal.dot(pose.position - path.point(path.along()));
  const double middle = beside + 0.5 * (left - right);
  offset_ += std::min(1.0, dt / kTimeConstant) * middle * normal;
  if (offset_.norm() > limit_) offset_ *= limit_ / offset_.norm();
}

}  // namespace fleetmap::planning
