#include "fleetmap/agent/navigator.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "fleetmap/wire/messages.hpp"
#include "fleetmap/wire/sensors.hpp"
#include "fleetmap/wire/topics.hpp"

namespace fleetmap::agent {
namespace {

exchange::MissionReport to_wire(const planning::MissionReport& report) {
  exchange::MissionReport out;
  out.from = report.agent;
  out.stamp = report.stamp;
  out.state = static_cast<std::uint8_t>(report.state);
  out.east = static_cast<float>(report.position.x());
  out.north = static_cast<float>(report.position.y());
  out.battery = static_cast<float>(std::clamp(report.battery, 0.0, 1.0));
  const std::set<planning::RowId> done(report.done.begin(), report.done.end());
  for (const planning::RowId row : done) {
    if (!out.done.empty() && out.done.back().first + out.done.back().count == row) {
      ++out.done.back().count;
    } else {
      out.done.push_back({row, 1});
    }
  }
  out.claimed = report.claimed;
  return out;
}

planning::MissionReport from_wire(const exchange::MissionReport& report) {
  planning::MissionReport out;
  out.agent = report.from;
  out.stamp = report.stamp;
  out.state = static_cast<planning::MissionState>(report.state);
  out.position = {static_cast<double>(report.east), static_cast<double>(report.north)};
  out.battery = static_cast<double>(report.battery);
  for (const auto& span : report.done) {
    // A span may claim a million rows; no mission has more than kMaxRows.
    const std::uint32_t count = std::min<std::uint32_t>(span.count, planning::Mission::kMaxRows);
    for (std::uint32_t k = 0; k < count; ++k) out.done.push_back(span.first + k);
  }
  out.claimed = report.claimed;
  return out;
}

}  // namespace

std::vector<Eigen::Vector2d> obstacles_among(const std::vector<Eigen::Vector3f>& points_base,
                                             const ObstacleConfig& config) {
  std::vector<Eigen::Vector2d> obstacles;
  std::set<std::pair<int, int>> cells;
  const double reach2 = config.reach * config.reach;
  for (const Eigen::Vector3f& point : points_base) {
    const Eigen::Vector3d p = point.cast<double>();
    const double distance2 = p.head<2>().squaredNorm();
    if (!(distance2 <= reach2)) continue;
    const double height = p.z() + config.base_height;
    const double rise = config.slope * std::sqrt(distance2);
    if (height < config.min_height + rise || height > config.max_height + rise) continue;
    const std::pair cell{static_cast<int>(std::floor(p.x() / config.spacing)),
                         static_cast<int>(std::floor(p.y() / config.spacing))};
    if (cells.insert(cell).second) obstacles.emplace_back(p.head<2>());
  }
  return obstacles;
}

Navigator::Navigator(const NavigatorConfig& config, const AgentId& self, const GeoPoint& site, bus::Bus& bus,
                     Tell tell)
    : config_(config),
      site_(site),
      bus_(bus),
      tell_(std::move(tell)),
      executive_(config.plan, self),
      follower_(config.follower) {
  bus_.advertise(wire::topics::cmd_vel());
  battery_subscription_ = bus_.subscribe(wire::topics::battery(), [this](const Bytes& cdr) {
    if (const auto battery = wire::decode<sensor::Battery>(cdr)) battery_ = battery->share;
  });
}

std::optional<planning::Pose2> Navigator::pose_of(const GlobalPose& G) const {
  const Eigen::Vector3d p = site_.to_enu(G.position);
  // The heading is about the ENU axes of the place; across a site they differ by far less than it is known.
  const double yaw = rpy_from_rotation(G.q_enu_base.toRotationMatrix()).z();
  if (!p.allFinite() || !std::isfinite(yaw)) return std::nullopt;
  return planning::Pose2{p.head<2>(), yaw};
}

void Navigator::drive(const planning::Command& command) {
  bus_.publish(wire::topics::cmd_vel(),
               wire::encode(wire::VelocityCommand{command.forward_speed, command.yaw_rate}));
}

void Navigator::on_perceived(const Perceived& perceived) {
  if (stopped_) return;
  if (perceived.G) pose_ = pose_of(*perceived.G);
  // Without a pose there is no telling where to; the robot waits.
  if (!perceived.G || !pose_ || holding_) return drive({});
  const double speed = perceived.odometry.twist.x();
  drive(follower_.update(*pose_, speed, obstacles_among(perceived.odometry.points.points, config_.obstacles),
                         bus_.now()));
}

void Navigator::on_report(const exchange::MissionReport& report) {
  executive_.on_report(from_wire(report), bus_.now());
}

void Navigator::stop() {
  stopped_ = true;
  drive({});
}

}  // namespace fleetmap::agent
