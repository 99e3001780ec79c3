#include "fleetmap/planning/driving/path_follower.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "driving/arc_rollout.hpp"
#include "driving/lane_offset.hpp"
#include "driving/local_field.hpp"
#include "driving/path_progress.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::planning {
namespace {

constexpr double kWay = LocalField::kUnreachable;
constexpr double kCornerSpeed = 0.6;   // m/s
constexpr double kCreep = 0.25;        // m/s, the slowest that still gets on
constexpr double kAligned = 0.3;       // rad, heading error at which turning on the spot ends
constexpr double kDriveOn = 1.5;       // s, after a turn on the spot
constexpr double kBackOffTime = 1.5;   // s
constexpr double kRotationGain = 1.8;  // 1/s

}  // namespace

struct PathFollower::State {
  explicit State(const PathFollowerConfig& settings)
      : config(settings),
        field(settings.horizon + 0.7, settings.wanted_clearance),
        lane(settings.lateral_error) {}

  void note_progress(Stamp now, const Eigen::Vector2d& position);
  std::vector<LocalField::Source> sources(const Pose2& pose) const;
  double speed_limit(const Pose2& pose) const;
  Command drive(const Pose2& pose, double speed, Stamp now);
  Command follow(const Arc& arc, double limit) const;
  Command turn(double error, double yaw);
  Command back_off(Stamp now);
  Command held(const Command& wanted, double speed, double dt);

  PathFollowerConfig config;
  LocalField field;
  PathProgress path;
  bool finished = true;
  bool gave_up = false;
  bool turning = false;
  double turn_sign = 1.0;
  double turn_goal = 0.0;  // rad, from east
  Stamp drive_until{};     // until then it drives on after a turn on the spot
  double curvature = 0.0;
  LaneOffset lane;
  double touch = 0.0;       // m, clearance below which the robot would touch something
  double last_speed = 0.0;  // m/s, commanded
  Stamp last_update{};
  bool started = false;
  Stamp backing_until{};
  Stamp progress_at{};  // when it last got on
  double progress_mark = 0.0;
  Stamp nearer_at{};  // when it last came nearer to the next waypoint
  double nearest = 0.0;
  double nearest_corner = -1.0;
};

/// The places ahead that would be progress: across the path at the end of the horizon, since the free lane
/// may lie beside it; at a much higher price the rest of the rim, to get around what is in the way.
std::vector<LocalField::Source> PathFollower::State::sources(const Pose2& pose) const {
  const double corner = path.next_corner();
  const double ahead = std::min({path.along() + config.horizon, corner, path.length()});
  const Eigen::Vector2d tangent = path.tangent(std::max(0.0, ahead - 1e-6));
  const Eigen::Vector2d side(-tangent.y(), tangent.x());
  const double c = std::cos(pose.yaw);
  const double s = std::sin(pose.yaw);
  const auto to_base = [&](const Eigen::Vector2d& p) -> Eigen::Vector2d {
    const Eigen::Vector2d d = p - pose.position;
    return {c * d.x() + s * d.y(), -s * d.x() + c * d.y()};
  };
  std::vector<LocalField::Source> sources;
  const Eigen::Vector2d aim = path.point(ahead);
  for (double y = -config.lateral_error; y <= config.lateral_error; y += 0.1) {
    const Eigen::Vector2d at = to_base(aim + y * side);
    const double tight = std::max(0.0, 1.0 - field.clearance(at) / config.wanted_clearance);
    sources.push_back({at, config.lateral_weight * (std::abs(y) + 0.3 * y * y) + tight * tight});
  }
  const Eigen::Vector2d aim_base = to_base(aim);
  const double rim = field.reach() - 0.1;
  for (double t = -rim; t <= rim; t += 0.2) {
    for (const Eigen::Vector2d& p : {Eigen::Vector2d(t, rim), Eigen::Vector2d(t, -rim),
                                     Eigen::Vector2d(rim, t), Eigen::Vector2d(-rim, t)}) {
      sources.push_back({p, 10.0 + 2.0 * (p - aim_base).norm()});
    }
  }
  return sources;
}

/// m/s, for what the path does next.
double PathFollower::State::speed_limit(const Pose2& pose) const {
  const double corner = path.next_corner();
  const double away = std::max(corner - path.along(), (path.point(corner) - pose.position).norm() - 1.0);
  const double then = corner >= path.length() ? kCreep : kCornerSpeed;
  return std::min(config.max_speed,
                  std::sqrt(then * then + 2.0 * 0.6 * config.braking * std::max(0.0, away)));
}

Command PathFollower::State::turn(double error, double yaw) {
  if (!turning) turn_goal = wrap_angle(yaw + error);
  if (!turning || std::abs(error) < 2.5) turn_sign = error >= 0.0 ? 1.0 : -1.0;
  turning = true;
  const double rate = std::clamp(kRotationGain * std::abs(error), 0.3, config.max_yaw_rate);
  return {0.0, turn_sign * rate};
}

/// Straight back, slowly, as long as there is room.
Command PathFollower::State::back_off(Stamp now) {
  const double here = field.clearance(Eigen::Vector2d::Zero());
  const double behind = field.clearance({-0.3, 0.0});
  if (behind < std::min(touch, here + 0.02) && behind <= here) {
    backing_until = now;
    return {0.0, turn_sign * 0.4};
  }
  return {-config.max_reverse, 0.0};
}

Command PathFollower::State::drive(const Pose2& pose, double speed, Stamp now) {
  // Whoever stands too close to something may still drive away from it.
  const double here = field.clearance(Eigen::Vector2d::Zero());
  touch = std::min(config.robot_radius + 0.5 * config.margin, std::max(0.15, here - 0.02));
  field.spread(sources(pose), touch);
  if (now < backing_until) return back_off(now);
  const double limit = speed_limit(pose);
  if (field.cost(Eigen::Vector2d::Zero()) >= kWay) {
    backing_until = now + from_seconds(kBackOffTime);
    return back_off(now);
  }
  // An arc that leads beyond the aim says nothing about how to get there.
  const double to_aim =
      std::min(field.cost(Eigen::Vector2d::Zero()), std::max(0.0, path.next_corner() - path.along()) + 0.3);
  const double length = std::clamp(std::min(1.2 * speed + 0.9, 0.8 * to_aim), 3.0 * kRolloutStep, 2.7);
  // A turn once begun is ended, and then driven along for a while: two ways around something may cost the
  // same.
  const double wanted = turning ? wrap_angle(turn_goal - pose.yaw) : descent_heading(field);
  const double error = turning && std::abs(wanted) < kAligned ? descent_heading(field) : wanted;
  if (turning && std::abs(wanted) < kAligned) drive_until = now + from_seconds(kDriveOn);
  turning = turning && std::abs(wanted) >= kAligned;
  if (turning || (std::abs(error) > config.turn_in_place && now >= drive_until)) {
    return turn(error, pose.yaw);
  }
  const Arc arc = best_arc(field, {length, touch, config.wanted_clearance, curvature});
  if (arc.score >= kWay) {
    if (std::abs(error) > kAligned) return turn(error, pose.yaw);
    backing_until = now + from_seconds(kBackOffTime);
    return back_off(now);
  }
  curvature = arc.curvature;
  return follow(arc, limit);
}

/// As fast as the robot can stop before what it would touch, and slowly past what is near.
Command PathFollower::State::follow(const Arc& arc, double limit) const {
  const double room = std::max(0.0, arc.free - kRolloutStep);
  const double a = config.braking;
  const double t = config.reaction_time;
  const double stoppable = a * (std::sqrt(t * t + 2.0 * room / a) - t);
  const double tight = config.robot_radius + config.margin;
  const double careful =
      0.35 + (config.max_speed - 0.35) * std::clamp((arc.clearance - tight) / 0.6, 0.0, 1.0);
  double v = std::min({limit, stoppable, careful});
  if (std::abs(arc.curvature) > 1e-6) v = std::min(v, config.max_yaw_rate / std::abs(arc.curvature));
  v = std::max(v, 0.15);
  return {v, v * arc.curvature};
}

/// Within what the chassis can follow: speed rises no faster than `acceleration`.
Command PathFollower::State::held(const Command& wanted, double speed, double dt) {
  const double fastest = std::max(std::max(speed, last_speed), 0.0) + config.acceleration * dt;
  Command command = wanted;
  if (command.forward_speed > fastest) {
    command.yaw_rate *= fastest / command.forward_speed;
    command.forward_speed = fastest;
  }
  command.yaw_rate = std::clamp(command.yaw_rate, -config.max_yaw_rate, config.max_yaw_rate);
  last_speed = command.forward_speed;
  return command;
}

void PathFollower::State::note_progress(Stamp now, const Eigen::Vector2d& position) {
  path.advance(position, config.corner_tolerance, config.lateral_error + 1.0);
  const double corner = path.next_corner();
  const double away = (path.point(corner) - position).norm();
  if (corner != nearest_corner || away < nearest - 0.15) {
    nearest = away;
    nearest_corner = corner;
    nearer_at = now;
  }
  const bool end = corner >= path.length();
  if (end && (away <= config.goal_tolerance ||
              (path.length() - path.along() < 0.3 && away <= config.lateral_error))) {
    finished = true;
    return;
  }
  if (away < config.give_up_radius && now - nearer_at > from_seconds(config.give_up_after)) {
    path.skip_corner();
    gave_up = end;
    finished = end;
    nearest_corner = -1.0;
  }
  if (path.along() > progress_mark + config.stuck_distance) {
    progress_mark = path.along();
    progress_at = now;
  }
}

PathFollower::PathFollower(const PathFollowerConfig& config) {
  if (const Status status = config.validate(); !status) throw std::invalid_argument(status.error().message);
  state_ = std::make_unique<State>(config);
}
PathFollower::~PathFollower() = default;
PathFollower::PathFollower(PathFollower&&) noexcept = default;
PathFollower& PathFollower::operator=(PathFollower&&) noexcept = default;

void PathFollower::set_path(Polyline path) {
  State& state = *state_;
  state.path = PathProgress(path);
  state.finished = state.path.empty();
  state.gave_up = false;
  state.turning = false;
  state.drive_until = state.backing_until = Stamp{};
  state.started = false;
  state.nearest_corner = -1.0;
  state.progress_mark = 0.0;
}

Command PathFollower::update(const Pose2& pose, double speed,
                             const std::vector<Eigen::Vector2d>& obstacles_in_base, Stamp now) {
  State& state = *state_;
  if (state.finished || !pose.position.allFinite() || !std::isfinite(pose.yaw)) {
    state.last_speed = 0.0;
    return {};
  }
  if (!std::isfinite(speed)) speed = 0.0;
  if (!state.started) {
    state.started = true;
    state.progress_at = state.nearer_at = state.last_update = now;
  }
  const double dt = std::clamp(to_seconds(now - state.last_update), 0.02, 0.5);
  state.last_update = now;
  state.field.see(obstacles_in_base);
  Pose2 corrected = pose;
  corrected.position -= state.lane.offset();
  state.note_progress(now, corrected.position);
  if (state.finished) {
    state.last_speed = 0.0;
    return {};
  }
  state.lane.update(state.path, state.field, corrected, dt);
  return state.held(state.drive(corrected, speed, now), speed, dt);
}

void PathFollower::pause(Stamp now) {
  state_->progress_at = state_->nearer_at = state_->last_update = now;
  state_->last_speed = 0.0;
}

double PathFollower::progress() const { return state_->path.along(); }
double PathFollower::remaining() const { return state_->path.length() - state_->path.along(); }
bool PathFollower::finished() const { return state_->finished; }
bool PathFollower::gave_up_end() const { return state_->gave_up; }
bool PathFollower::stuck(Stamp now) const {
  return !state_->finished && state_->started &&
         now - state_->progress_at > from_seconds(state_->config.stuck_after);
}
const PathFollowerConfig& PathFollower::config() const { return state_->config; }

}  // namespace fleetmap::planning
