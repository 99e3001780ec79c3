#include "surveying_fleet.hpp"

#include <utility>

#include "convergence.hpp"
#include "exchange_config.hpp"
#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/exchange/reissue.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "session_draw.hpp"
#include "tick.hpp"

namespace fleetmap::fault_injection {
namespace {

constexpr Duration kStartRetry = std::chrono::seconds(5);
constexpr Duration kSessionPause = std::chrono::minutes(1);  // as agent::Agent
constexpr Duration kPlacementPeriod = std::chrono::seconds(40);
constexpr Duration kDrivePeriod = std::chrono::seconds(1), kReportPeriod = std::chrono::seconds(5);
constexpr double kMaxRegistration = 3.0;  // s
constexpr std::uint64_t kFleetStream = 7;

/// True once in each period.
bool is_due(Stamp now, Duration period) {
  return to_ns(now) / period.count() != (to_ns(now) - kTick.count()) / period.count();
}

store::StoreConfig store_on(const FaultyFileSystem& disk) {
  store::StoreConfig config;
  config.file_system = disk.name();
  return config;
}

}  // namespace

SurveyingFleet::SurveyingFleet(const Scenario& scenario, const RunConfig& config,
                               const std::filesystem::path& folder)
    : ExchangeFleet(folder, exchange_config_of(scenario, config.signatures), kTick),
      trace_(config.trace),
      survey_(scenario.seed, scenario.robots),
      monitor_(now(), config_, config.invariants),
      draws_(scenario.seed, kFleetStream),
      start_(now()),
      mission_(config_.fleet) {
  for (std::size_t k = 0; k < scenario.robots; ++k) {
    Member& member = members_[name_of(k)];
    member.index = k;
    member.disk = std::make_unique<FaultyFileSystem>();
    member.start_at = now() + from_seconds(draws_.between(0.0, 5.0));
  }
}

void SurveyingFleet::kill_robot(const AgentId& name) {
  member(name).start_at.reset();
  if (!runs(name)) return;
  kill(name);
  monitor_.on_stopped(name);
  jobs_.drop(name);
  mission_.stop(name);
}

void SurveyingFleet::start_in_vain(const AgentId& name, std::size_t count) {
  const Member& member = this->member(name);
  for (std::size_t k = 0; k < count; ++k) {
    auto store = open_store(name, store_on(*member.disk));
    const auto session =
        store ? draw_session(*store, draws_) : Result<std::uint16_t>(tl::unexpected(store.error()));
    if (session || member.disk->is_full()) continue;
    monitor_.note(Invariant::kStarts, name, now(), session.error().message);
    return;
  }
}

void SurveyingFleet::restart_odometry(const AgentId& name) {
  Member& member = this->member(name);
  if (!runs(name)) return;
  ++member.odometry.map_restarts;
  survey_.begin_frame(member.index, time());
}

void SurveyingFleet::start_robots(bool may_fail) {
  for (auto& [name, member] : members_) {
    if (member.start_at && now() >= *member.start_at) start_robot(name, member, may_fail);
  }
}

void SurveyingFleet::start_robot(const AgentId& name, Member& member, bool may_fail) {
  const Status started = start(name, store_on(*member.disk), member.clock_offset,
                               [this](store::Store& opened) { return draw_session(opened, draws_); });
  if (!started) {
    trace(name.str() + " cannot start: " + started.error().message);
    if (!may_fail) monitor_.note(Invariant::kStarts, name, now(), started.error().message);
    member.start_at = now() + kStartRetry;
    return;
  }
  member.start_at.reset();
  member.session_begun = now();
  member.placed_items = 0;
  member.frame.begun(member.odometry);
  const Robot& robot = this->robot(name);
  survey_.begin_frame(member.index, time());
  mission_.start(name);
  trace(name.str() + " starts in session " + std::to_string(robot.session) + " with " +
        std::to_string(robot.store->nodes().size()) + " nodes");
  monitor_.on_started(name, *robot.store, std::exchange(member.disk_intact, true), now());
}

bool SurveyingFleet::begin_session(const AgentId& name, Robot& robot, const char* why) {
  Member& member = this->member(name);
  const auto session = draw_session(*robot.store, draws_);
  if (!session) return false;
  trace(name.str() + " begins session " + std::to_string(*session) + ": " + why);
  member.session_begun = now();
  member.frame.begun(member.odometry);
  robot.session = *session;
  robot.exchange->begin_session(*session);
  survey_.begin_frame(member.index, time());
  return true;
}

void SurveyingFleet::reissue(const AgentId& name, Robot& robot) {
  const exchange::NewNames names{
      robot.session, [&] { return draw_session(*robot.store, draws_); },
      [](const graph::Alignment& alignment) { return fleet_codec::quantised(alignment); }};
  const auto reissued = exchange::reissue_contested(*robot.exchange, *robot.store, names, clock(robot));
  trace(name.str() +
        (reissued ? " names " + std::to_string(*reissued) + " items anew" : ": " + reissued.error().message));
}

void SurveyingFleet::on_event(const AgentId& name, Robot& robot, const exchange::Event& event) {
  if (const auto line = trace_line(event)) trace(name.str() + ": " + *line);
  if (const auto* needed = std::get_if<exchange::CloudNeeded>(&event)) {
    Bytes cloud =
        is_compromised(name) ? compromised_->oversize_cloud() : SyntheticSurvey::cloud_around(needed->node);
    const Status provided = robot.exchange->provide_cloud(needed->node, std::move(cloud), clock(robot));
    if (!provided) monitor_.note(Invariant::kOwnItems, name, now(), provided.error().message);
  } else if (const auto* conflict = std::get_if<exchange::ItemConflict>(&event)) {
    monitor_.on_conflict(name, *conflict, now());
    if (conflict->id.agent == name) reissue(name, robot);
  } else if (std::holds_alternative<exchange::SessionTaken>(event)) {
    if (now() - member(name).session_begun >= kSessionPause)
      begin_session(name, robot, "its number was given before");
  } else if (const auto* heard = std::get_if<exchange::MissionHeard>(&event)) {
    mission_.on_report(name, heard->report, clock(robot));
  }
}

void SurveyingFleet::on_received(const AgentId& name, Robot& robot,
                                 const loop_closure::ReceivedCloud& received) {
  // As a registration decodes it.
  if (const auto cloud = cloud::decode(received.cloud))
    monitor_.on_decoded(name, received.cloud, *cloud, now());
  jobs_.add({now() + from_seconds(draws_.between(0.1, kMaxRegistration)), name, robot.session,
             received.candidate.pair()});
}

void SurveyingFleet::map(const AgentId& name, Robot& robot) {
  Member& member = this->member(name);
  const bool admits =
      member.frame.admits(member.odometry, [&](const char* why) { return begin_session(name, robot, why); });
  if (!admits) return;
  const NodeId id{name, robot.store->next_node_seq(robot.session)};
  auto made = survey_.node(member.index, id, time());
  if (!made) return;
  if (is_compromised(name)) made->node = compromised_->falsified(made->node, survey_.site());
  const auto put = robot.exchange->on_own_node(made->node, made->submap, clock(robot));
  if (!put) return;
  if (*put != store::Put::kAdded) {
    monitor_.note(Invariant::kOwnItems, name, now(),
                  "its own node " + to_string(id) + " is refused by its store");
    return;
  }
  survey_.on_stored(member.index, id, time());
  monitor_.on_made(made->node);
  trace(to_string(id) + " made");
}

void SurveyingFleet::finish_jobs() {
  for (const RegistrationJob& job : jobs_.take_due(now())) {
    Robot& robot = this->robot(job.robot);
    auto alignment = survey_.registration(job.pair, robot.store->next_alignment_seq(robot.session));
    if (alignment && (is_compromised(job.pair.ours.agent) || is_compromised(job.pair.theirs.agent)))
      alignment = compromised_->falsified(*alignment, survey_);
    const auto put = alignment ? robot.exchange->on_own_alignment(*alignment, clock(robot))
                               : Result<store::Put>(store::Put::kInvalid);
    if (put && *put == store::Put::kAdded) {
      trace(job.robot.str() + " aligned " + to_string(job.pair.ours) + " with " + to_string(job.pair.theirs));
      continue;
    }
    if (alignment && put)
      monitor_.note(Invariant::kOwnItems, job.robot, now(), "its own alignment is refused");
    robot.cloud_client->on_rejected(job.pair, clock(robot));
  }
}

void SurveyingFleet::place(const AgentId& name, Robot& robot) {
  Member& member = this->member(name);
  const std::size_t items = robot.store->nodes().size() + robot.store->alignments().size();
  if (!is_due(now(), kPlacementPeriod) || items == member.placed_items) return;
  member.placed_items = items;
  robot.cloud_client->on_used_alignments(placement_of(robot, survey_.site()).used);
}

void SurveyingFleet::drive(const AgentId& name, Robot& robot) {
  if (!is_due(now(), kDrivePeriod)) return;
  mission_.drive(name, to_seconds(kDrivePeriod), clock(robot));
  const std::optional<AgentId> compromised =
      compromised_ ? std::optional(compromised_->self()) : std::nullopt;
  if (is_due(now(), kReportPeriod))
    robot.exchange->send_report(is_compromised(name) ? mission_.false_report(name, clock(robot))
                                                     : mission_.report(name));
  if (is_compromised(name) || anyone_reports_) return;
  if (const auto row = mission_.skipped_row(name, compromised))
    monitor_.note(Invariant::kRows, name, now(),
                  "counts row " + std::to_string(*row) + " as driven, which nobody drove");
}

void SurveyingFleet::survey(bool maps) {
  for (const auto& [name, entry] : robots()) {
    Robot& robot = this->robot(name);
    robot.events.clear();
    robot.received.clear();
    if (maps) {
      map(name, robot);
      drive(name, robot);
    }
    place(name, robot);
  }
  finish_jobs();
}

}  // namespace fleetmap::fault_injection
