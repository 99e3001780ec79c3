#include "fleetmap/planning/driving/path_follower.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "driving/local_field.hpp"
#include "driving/path_progress.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::planning {
namespace {

constexpr double kWay = LocalField::kUnreachable;
constexpr double kCornerSpeed = 0.6;   // m/s
constexpr double kCreep = 0.25;        // m/s, the slowest that still gets on
constexpr double kStep = 0.15;         // m, between looked-at points of an arc
constexpr double kAligned = 0.3;       // rad, heading error at which turning on the spot ends
constexpr double kDriveOn = 1.5;       // s, after a turn on the spot
constexpr double kBackOffTime = 1.5;   // s
constexpr double kRotationGain = 1.8;  // 1/s
constexpr double kLaneReach = 3.0;     // m to each side in which the borders of a lane are looked for
constexpr double kLaneLearning = 5.0;  // s, in which a lane corrects the position across it
constexpr double kLaneMemory = 180.0;  // s, after which an error of the position is no longer believed
constexpr std::array<double, 21> kCurvatures = {0.0,  0.05, -0.05, 0.1,   -0.1, 0.18,  -0.18,
                                                0.3,  -0.3, 0.45,  -0.45, 0.65, -0.65, 0.9,
                                                -0.9, 1.3,  -1.3,  2.0,   -2.0, 3.0,   -3.0};

struct Arc {
  double curvature = 0.0;
  double score = kWay;
  double free = 0.0;       // m, until it would touch
  double clearance = 0.0;  // m, least over the first metre
};

Eigen::Vector2d on_arc(double curvature, double length) {
  const double angle = curvature * length;
  if (std::abs(angle) < 1e-6) return {length, 0.5 * curvature * length * length};
  return {std::sin(angle) / curvature, (1.0 - std::cos(angle)) / curvature};
}

}  // namespace

struct PathFollower::State {
  explicit State(const PathFollowerConfig& settings)
      : config(settings), field(settings.horizon + 0.7, settings.wanted_clearance) {}

  void note_progress(Stamp now, const Eigen::Vector2d& position);
  std::vector<LocalField::Source> sources(const Pose2& pose) const;
  double wanted_heading() const;
  Arc best_arc(double length) const;
  Arc roll_out(double curvature, double length) const;
  double speed_limit(const Pose2& pose) const;
  void learn_lane(const Pose2& pose, double dt);
  Command drive(const Pose2& pose, double speed, Stamp now);
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
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();  // m, by which the known position seems to be off
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

Status PathFollowerConfig::validate() const {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0.0; };
  for (const auto& [name, value] : {std::pair<const char*, double>{"max_speed", max_speed},
                                    {"max_reverse", max_reverse},
                                    {"max_yaw_rate", max_yaw_rate},
                                    {"acceleration", acceleration},
                                    {"braking", braking},
                                    {"robot_radius", robot_radius},
                                    {"wanted_clearance", wanted_clearance},
                                    {"horizon", horizon},
                                    {"corner_tolerance", corner_tolerance},
                                    {"goal_tolerance", goal_tolerance},
                                    {"give_up_radius", give_up_radius},
                                    {"give_up_after", give_up_after},
                                    {"turn_in_place", turn_in_place},
                                    {"stuck_after", stuck_after},
                                    {"stuck_distance", stuck_distance}}) {
    if (!positive(value)) return failure(std::string(name) + ": must be finite and > 0");
  }
  for (const auto& [name, value] : {std::pair<const char*, double>{"reaction_time", reaction_time},
                                    {"margin", margin},
                                    {"lateral_doubt", lateral_doubt},
                                    {"lateral_weight", lateral_weight}}) {
    if (!(std::isfinite(value) && value >= 0.0))
      return failure(std::string(name) + ": must be finite and >= 0");
  }
  if (horizon < 2.0 || horizon > 15.0) return failure("horizon: must be within [2, 15] m");
  if (wanted_clearance <= robot_radius + margin || wanted_clearance > 5.0) {
    return failure("wanted_clearance: must be above robot_radius + margin and at most 5 m");
  }
  return {};
}

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
  for (double y = -config.lateral_doubt; y <= config.lateral_doubt; y += 0.1) {
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

/// Direction in which the field falls, over about half a metre.
double PathFollower::State::wanted_heading() const {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();
  for (int step = 0; step < 4; ++step) {
    double best = kWay;
    Eigen::Vector2d next = p;
    for (int k = 0; k < 24; ++k) {
      const double angle = k * (6.283185307179586 / 24.0);
      const Eigen::Vector2d q = p + 0.25 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      const double cost = field.cost(q);
      if (cost < best) {
        best = cost;
        next = q;
      }
    }
    if (best >= field.cost(p)) break;
    p = next;
  }
  return p.norm() < 0.1 ? 0.0 : std::atan2(p.y(), p.x());
}

Arc PathFollower::State::roll_out(double kappa, double length) const {
  Arc arc{kappa, kWay, 0.0, config.wanted_clearance};
  if (std::abs(kappa) > 1e-6) length = std::min(length, 1.6 / std::abs(kappa));
  double price = 0.0;
  for (double s = kStep; s <= length + 1e-9; s += kStep) {
    const double clearance = field.clearance(on_arc(kappa, s));
    if (clearance < touch) break;
    if (s <= 1.0) arc.clearance = std::min(arc.clearance, clearance);
    price += kStep * field.price_of_metre(clearance);
    arc.free = s;
  }
  if (arc.free < 2.0 * kStep) return arc;
  const bool cut_short = arc.free + kStep < length;
  const double rest = field.cost(on_arc(kappa, arc.free));
  if (rest >= kWay) return arc;
  arc.score = price + rest + (cut_short ? 0.3 : 0.0) + 0.04 * std::abs(kappa) +
              0.05 * std::min(2.0, std::abs(kappa - curvature));
  return arc;
}

Arc PathFollower::State::best_arc(double length) const {
  Arc best;
  for (const double kappa : kCurvatures) {
    const Arc arc = roll_out(kappa, length);
    if (arc.score < best.score) best = arc;
  }
  return best;
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

/// Between two borders the lane's middle is where the path means to be: what is missing to it is an error of
/// the position, which is still there when the robot looks for the entrance of the next lane.
void PathFollower::State::learn_lane(const Pose2& pose, double dt) {
  offset *= std::exp(-dt / kLaneMemory);
  const Eigen::Vector2d tangent = path.tangent(path.along());
  const double off_course = wrap_angle(std::atan2(tangent.y(), tangent.x()) - pose.yaw);
  if (std::abs(off_course) > 0.35) return;
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
  offset += std::min(1.0, dt / kLaneLearning) * middle * normal;
  if (offset.norm() > config.lateral_doubt) offset *= config.lateral_doubt / offset.norm();
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
  const double length = std::clamp(std::min(1.2 * speed + 0.9, 0.8 * to_aim), 3.0 * kStep, 2.7);
  // A turn once begun is ended, and then driven along for a while: two ways around something may cost the
  // same.
  const double wanted = turning ? wrap_angle(turn_goal - pose.yaw) : wanted_heading();
  const double error = turning && std::abs(wanted) < kAligned ? wanted_heading() : wanted;
  if (turning && std::abs(wanted) < kAligned) drive_until = now + from_seconds(kDriveOn);
  turning = turning && std::abs(wanted) >= kAligned;
  if (turning || (std::abs(error) > config.turn_in_place && now >= drive_until)) {
    return turn(error, pose.yaw);
  }
  const Arc arc = best_arc(length);
  if (arc.score >= kWay) {
    if (std::abs(error) > kAligned) return turn(error, pose.yaw);
    backing_until = now + from_seconds(kBackOffTime);
    return back_off(now);
  }
  curvature = arc.curvature;
  const double room = std::max(0.0, arc.free - kStep);
  const double a = config.braking;
  const double t = config.reaction_time;
  const double stoppable = a * (std::sqrt(t * t + 2.0 * room / a) - t);
  const double tight = config.robot_radius + config.margin;
  const double careful =
      0.35 + (config.max_speed - 0.35) * std::clamp((arc.clearance - tight) / 0.6, 0.0, 1.0);
  double v = std::min({limit, stoppable, careful});
  if (std::abs(curvature) > 1e-6) v = std::min(v, config.max_yaw_rate / std::abs(curvature));
  v = std::max(v, 0.15);
  return {v, v * curvature};
}

/// Within what the chassis can follow: speed rises no faster than `acceleration`.
Command PathFollower::State::held(const Command& wanted, double speed, double dt) {
  const double most = std::max(std::max(speed, last_speed), 0.0) + config.acceleration * dt;
  Command command = wanted;
  if (command.forward_speed > most) {
    command.yaw_rate *= most / command.forward_speed;
    command.forward_speed = most;
  }
  command.yaw_rate = std::clamp(command.yaw_rate, -config.max_yaw_rate, config.max_yaw_rate);
  last_speed = command.forward_speed;
  return command;
}

void PathFollower::State::note_progress(Stamp now, const Eigen::Vector2d& position) {
  path.advance(position, config.corner_tolerance, config.lateral_doubt + 1.0);
  const double corner = path.next_corner();
  const double away = (path.point(corner) - position).norm();
  if (corner != nearest_corner || away < nearest - 0.15) {
    nearest = away;
    nearest_corner = corner;
    nearer_at = now;
  }
  const bool end = corner >= path.length();
  if (end && (away <= config.goal_tolerance ||
              (path.length() - path.along() < 0.3 && away <= config.lateral_doubt))) {
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
  corrected.position -= state.offset;
  state.note_progress(now, corrected.position);
  if (state.finished) {
    state.last_speed = 0.0;
    return {};
  }
  state.learn_lane(corrected, dt);
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
