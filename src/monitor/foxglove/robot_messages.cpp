#include "robot_messages.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include "basic_types.hpp"

namespace fleetmap::monitor::foxglove {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr std::uint32_t kCovarianceUnknown = 0, kCovarianceKnown = 3;  // foxglove::PositionCovarianceType

/// Covariance of the node's position along east, north and up at `point`; m^2.
Eigen::Matrix3d position_covariance(const LastNode& last, const LocalFrame& frame, const GeoPoint& point) {
  const Eigen::Matrix3d R_local_node = frame.R_enu_local(point).transpose() * last.T_enu_node.linear();
  return R_local_node * last.covariance->topLeftCorner<3, 3>() * R_local_node.transpose();
}

std::uint32_t clamped(std::size_t value) {
  return static_cast<std::uint32_t>(std::min<std::size_t>(value, std::numeric_limits<std::uint32_t>::max()));
}

}  // namespace

Bytes transforms_message(const std::map<AgentId, LastNode>& robots) {
  CdrWriter cdr;
  cdr.count(robots.size());
  for (const auto& [robot, last] : robots) {
    write(cdr, last.stamp);
    cdr.text(kMapFrame);
    cdr.text(robot.str());
    write(cdr, last.T_enu_node);
  }
  return std::move(cdr).message();
}

Bytes fix_message(const AgentId& robot, const LastNode& last, const GeoPoint& origin) {
  const LocalFrame frame(origin);
  const GeoPoint point = frame.to_geo(last.T_enu_node.translation());
  CdrWriter cdr;
  write(cdr, last.stamp);
  cdr.text(robot.str());
  cdr.number(point.latitude * kDegrees);
  cdr.number(point.longitude * kDegrees);
  cdr.number(point.altitude);
  const Eigen::Matrix3d C =
      last.covariance ? position_covariance(last, frame, point) : Eigen::Matrix3d::Zero().eval();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) cdr.number(C(row, column));
  cdr.number(last.covariance ? kCovarianceKnown : kCovarianceUnknown);
  return std::move(cdr).message();
}

Bytes status_message(const RobotNow& robot) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  CdrWriter cdr;
  cdr.text(robot.id.str());
  cdr.text(robot.activity);
  cdr.count(robot.problems.size());
  for (const std::string& problem : robot.problems) cdr.text(problem);
  cdr.count(robot.heard.size());
  for (const LastHeard& heard : robot.heard) {
    cdr.text(heard.link);
    cdr.number(heard.seconds_ago);
  }
  cdr.number(robot.battery.value_or(kUnknown));
  cdr.number(robot.sigma_m.value_or(kUnknown));
  for (const std::size_t held : {robot.nodes, robot.alignments, robot.submaps, robot.backlog_bytes})
    cdr.number(clamped(held));
  cdr.flag(robot.ordered_to_hold);
  cdr.flag(robot.called_home);
  cdr.flag(robot.driven);
  return std::move(cdr).message();
}

}  // namespace fleetmap::monitor::foxglove
