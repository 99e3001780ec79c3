#include "fleetmap/agent/navigator.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/fleet_codec/topics.hpp"
#include "fleetmap/place/proximity_search.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/ros_codec/topics.hpp"

namespace fleetmap::agent {
namespace {

/// A guide that is silent for so long no longer guides: the robot uses its own G again, or stands still.
constexpr Duration kGuidePatience = std::chrono::seconds(1);

}  // namespace

Result<std::unique_ptr<Navigator>> Navigator::create(const NavigatorConfig& config, const AgentId& self,
                                                     const GeoPoint& site, bus::Bus& bus,
                                                     SendReport send_report) {
  auto executive = planning::MissionExecutive::create(config.plan, self);
  if (!executive) return tl::unexpected(executive.error());
  return std::unique_ptr<Navigator>(
      new Navigator(config, self, std::move(*executive), site, bus, std::move(send_report)));
}

Navigator::Navigator(const NavigatorConfig& config, const AgentId& self, planning::MissionExecutive executive,
                     const GeoPoint& site, bus::Bus& bus, SendReport send_report)
    : config_(config),
      site_(site),
      self_(self),
      bus_(bus),
      send_report_(std::move(send_report)),
      executive_(std::move(executive)),
      coverage_(executive_.plan().mission),
      follower_(config.follower),
      guard_(config.guard) {
  bus_.advertise(ros_codec::topics::cmd_vel());
  handles_.push_back(bus_.subscribe(ros_codec::topics::battery(), [this](const Bytes& cdr) {
    if (const auto battery = ros_codec::decode<sensor::Battery>(cdr)) battery_ = battery->share;
  }));
  handles_.push_back(bus_.subscribe(fleet_codec::topics::guide_pose(), [this](const Bytes& cdr) {
    const auto guide = fleet_codec::decode<GlobalPose>(cdr);
    const auto pose = guide ? pose_of(*guide) : std::nullopt;
    if (!pose) return;
    guide_ = pose;
    guided_at_ = bus_.now();
    guard_.on_pose(guided_at_);
  }));
  watch_ = bus_.every(DriveGuard::kPeriod, {"drive guard", [this] { watch(); }});
}

/// Also when an exception ends the program.
Navigator::~Navigator() {
  if (stop_reason_ != StopReason::kStopping) stop();
}

std::optional<planning::Pose2> Navigator::pose_of(const GlobalPose& G) const {
  const Eigen::Vector3d p = site_.to_enu(G.position);
  // The heading is about the ENU axes of the place; across a site they differ by far less than it is known.
  const double yaw = rpy_from_rotation(G.q_enu_base.toRotationMatrix()).z();
  if (!p.allFinite() || !std::isfinite(yaw)) return std::nullopt;
  return planning::Pose2{p.head<2>(), yaw};
}

bool Navigator::guided() const {
  const Duration age = bus_.now() - guided_at_;
  return guide_ && age >= Duration::zero() && age <= kGuidePatience;  // a clock may be set back
}

void Navigator::drive(const planning::Command& command) {
  const auto reason = guard_.check(bus_.now());
  note(reason);
  const planning::Command passed = reason ? planning::Command{} : command;
  bus_.publish(ros_codec::topics::cmd_vel(),
               ros_codec::encode(ros_codec::VelocityCommand{passed.forward_speed, passed.yaw_rate}));
}

void Navigator::note(const std::optional<StopReason>& reason) {
  drove_ |= !reason;
  if (reason == stop_reason_) return;
  if (!reason) {
    if (stopped_since_ != Stamp{}) spdlog::info("{}: may be driven", self_.str());
  } else if ((drove_ && !done()) || reason == StopReason::kHeld) {  // else there is nothing to warn of
    spdlog::log(reason == StopReason::kStopping ? spdlog::level::info : spdlog::level::warn,
                "{}: stands still: {}", self_.str(), to_string(*reason));
  }
  stop_reason_ = reason;
  stopped_since_ = bus_.now();
}

void Navigator::watch() {
  const auto reason = guard_.check(bus_.now());
  if (reason == StopReason::kHeld) follower_.pause(bus_.now());
  if (reason || stop_reason_) drive({});
}

bool Navigator::locate(const ScanEstimate& estimate) {
  const Stamp now = bus_.now();
  const bool lost = estimate.odometry.lost;
  if (!lost) guard_.on_odometry(estimate.arrival, now);
  if (guided()) {
    pose_ = guide_;
    return !lost;
  }
  if (!estimate.G) return false;
  pose_ = pose_of(*estimate.G);
  const double sigma = place::horizontal_sigma(estimate.G->covariance);
  if (!pose_ || !(sigma <= config_.guard.max_position_sigma)) return false;
  guard_.on_pose(now);
  return !lost;
}

void Navigator::on_estimate(const ScanEstimate& estimate) {
  const bool located = locate(estimate);
  const bool follow = action_.kind == planning::MissionAction::Kind::kFollow;
  if (!located || !follow || guard_.check(bus_.now())) return drive({});
  const double speed = estimate.odometry.twist.x();
  drive(follower_.update(*pose_, speed, obstacles_among(estimate.odometry.points.points, config_.obstacles),
                         bus_.now()));
}

void Navigator::on_report(const messages::MissionReport& report) { executive_.on_report(report, bus_.now()); }

void Navigator::on_node(const graph::Node& node) {
  if (node.G) coverage_.add(site_.to_enu(node.G->position).head<2>());
}

void Navigator::tick(bool maps_exchanged, std::vector<AgentId> exchanged_with) {
  if (stop_reason_ == StopReason::kStopping || !pose_) return;
  planning::MissionInput input;
  input.now = bus_.now();
  input.pose = *pose_;
  input.battery = battery_.value_or(1.0);
  input.path_number = action_.path_number;
  input.finished = follower_.finished();
  input.stuck = stuck(input.now);
  input.progress = follower_.progress();
  input.called_home = called_home_;
  input.maps_exchanged = maps_exchanged;
  input.exchanged_with = std::move(exchanged_with);
  input.surveyed = coverage_.covered();
  planning::MissionAction next = executive_.update(input);
  if (next.kind == planning::MissionAction::Kind::kFollow && next.path_number != action_.path_number)
    follower_.set_path(next.path);
  action_ = std::move(next);
  if (next_report_ && input.now < *next_report_) return;
  next_report_ = input.now + config_.report_period;
  send_report_(executive_.report());
}

bool Navigator::all_rows_driven() const {
  const auto status = executive_.status();
  return status.done + status.abandoned.size() >= status.rows;
}

/// A robot that is held may go on at any time; one that is blind for long is of no use to the mission.
bool Navigator::stuck(Stamp now) const {
  if (stop_reason_ == StopReason::kHeld) return false;
  const bool blind = stop_reason_ && now - stopped_since_ > from_seconds(config_.follower.stuck_after);
  return blind || follower_.stuck(now);
}

void Navigator::obey(const messages::HoldOrder& order) {
  const bool hold = order.stops(), home = order.calls_home();
  if (hold == guard_.held() && home == called_home_) return;
  guard_.set_held(hold);
  called_home_ = home;
  const char* what = hold ? "held" : home ? "on its way home" : "let go";
  spdlog::warn("{}: {} by order of {}", self_.str(), what, order.issuer.str());
  watch();
}

void Navigator::obey(const std::vector<messages::RowOrder>& orders) { executive_.set_row_orders(orders); }

void Navigator::stop() {
  guard_.stop();
  handles_.clear();
  drive({});
}

}  // namespace fleetmap::agent
