#include "faulty_fleet.hpp"

#include <algorithm>
#include <utility>

#include "convergence.hpp"
#include "exchange_config.hpp"
#include "fleetmap/exchange/reissue.hpp"
#include "fleetmap/fault_injection/stand_in_signatures.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/fleet_codec/topics.hpp"
#include "fleetmap/graph/compute_placement.hpp"
#include "fleetmap/output/placed_store.hpp"
#include "fleetmap/store/map_merge.hpp"
#include "fleetmap/store/sessions.hpp"
#include "session_draw.hpp"

namespace fleetmap::fault_injection {
namespace {

constexpr Duration kTick = std::chrono::milliseconds(50);
constexpr double kWifi = 50.0;  // m
constexpr Duration kStartRetry = std::chrono::seconds(5);
constexpr Duration kSessionPause = std::chrono::minutes(1);  // as agent::Agent
constexpr Duration kPlacementPeriod = std::chrono::seconds(40);
constexpr double kMaxRegistration = 3.0;  // s
constexpr std::uint64_t kFleetStream = 7;

std::string backup_name(std::size_t fault) { return std::string(".").append(std::to_string(fault)); }

}  // namespace

FaultyFleet::FaultyFleet(const Scenario& scenario, const RunConfig& config,
                         const std::filesystem::path& folder)
    : ExchangeFleet(folder, exchange_config_of(scenario, config.signatures), kTick),
      scenario_(scenario),
      run_(config),
      trace_(config.trace),
      start_(now()),
      survey_(scenario.seed, scenario.robots),
      links_(scenario.seed),
      attacker_(scenario.seed, config_.fleet, config.signatures),
      monitor_(now(), config_, config.invariants),
      draws_(scenario.seed, kFleetStream),
      changes_(changes_of(scenario)),
      next_check_(now()) {
  for (std::size_t k = 0; k < scenario.robots; ++k) {
    Member& member = members_[name_of(k)];
    member.index = k;
    member.disk = std::make_unique<FaultyFileSystem>();
    member.start_at = now() + from_seconds(draws_.between(0.0, 5.0));
  }
}

void FaultyFleet::apply(const FaultChange& change) {
  const Fault& fault = scenario_.faults[change.fault];
  switch (change.kind) {
    case FaultChange::Kind::kBackup:
      return keep_store(name_of(fault.robots[0]), backup_name(change.fault));
    case FaultChange::Kind::kBegin:
      trace(to_string(fault));
      return begin(fault, change.fault);
    case FaultChange::Kind::kEnd:
      trace("ends: " + to_string(fault));
      return end(fault);
  }
}

void FaultyFleet::begin(const Fault& fault, std::size_t number) {
  links_.begin(fault);
  if (fault.kind == FaultKind::kStranger || fault.kind == FaultKind::kForged) attacks_.insert(number);
  if (fault.robots.empty()) return;
  const AgentId& name = name_of(fault.robots[0]);
  Member& member = this->member(name);
  switch (fault.kind) {
    case FaultKind::kCrash:
      return stop_robot(name);
    case FaultKind::kClockStep:
      member.clock_offset = from_seconds(fault.value);
      return stop_robot(name);
    case FaultKind::kLostStore:
    case FaultKind::kOldStore:
    case FaultKind::kDamagedStore:
      stop_robot(name);
      member.disk_intact = false;
      if (fault.kind == FaultKind::kLostStore) return lose_store(name);
      if (fault.kind == FaultKind::kOldStore) return put_back_store(name, backup_name(number));
      return damage_store(name, fault.value);
    case FaultKind::kFullDisk:
      return member.disk->set_full(true);
    case FaultKind::kLiar:
      liars_.insert(name);
      return;
    default:
      return;
  }
}

void FaultyFleet::end(const Fault& fault) {
  links_.end(fault);
  attacks_.erase(static_cast<std::size_t>(&fault - scenario_.faults.data()));
  if (fault.robots.empty()) return;
  const AgentId& name = name_of(fault.robots[0]);
  Member& member = this->member(name);
  switch (fault.kind) {
    case FaultKind::kCrash:
    case FaultKind::kClockStep:
    case FaultKind::kLostStore:
    case FaultKind::kOldStore:
    case FaultKind::kDamagedStore:
      if (--member.stopped == 0) member.start_at = now();
      return;
    case FaultKind::kFullDisk:
      return member.disk->set_full(false);
    case FaultKind::kLiar:
      liars_.erase(liars_.find(name));
      return;
    default:
      return;
  }
}

void FaultyFleet::stop_robot(const AgentId& name) {
  Member& member = this->member(name);
  ++member.stopped;
  member.start_at.reset();
  if (!runs(name)) return;
  kill(name);
  monitor_.on_stopped(name);
  jobs_.drop(name);
}

void FaultyFleet::start_robots() {
  for (auto& [name, member] : members_) {
    if (member.start_at && now() >= *member.start_at) start_robot(name, member);
  }
}

void FaultyFleet::start_robot(const AgentId& name, Member& member) {
  store::StoreConfig store;
  store.file_system = member.disk->name();
  const Status started = start(name, store, member.clock_offset,
                               [this](store::Store& opened) { return draw_session(opened, draws_); });
  if (!started) {
    trace(name.str() + " cannot start: " + started.error().message);
    if (!mapping_) monitor_.note(Invariant::kStarts, name, now(), started.error().message);
    member.start_at = now() + kStartRetry;
    return;
  }
  member.start_at.reset();
  member.session_begun = now();
  member.placed_items = 0;
  const Robot& robot = this->robot(name);
  survey_.begin_frame(member.index, time());
  trace(name.str() + " starts in session " + std::to_string(robot.session) + " with " +
        std::to_string(robot.store->nodes().size()) + " nodes");
  monitor_.on_started(name, *robot.store, std::exchange(member.disk_intact, true), now());
}

void FaultyFleet::begin_session(const AgentId& name, Robot& robot) {
  Member& member = this->member(name);
  if (now() - member.session_begun < kSessionPause) return;
  const auto session = draw_session(*robot.store, draws_);
  if (!session) return;
  trace(name.str() + " begins session " + std::to_string(*session) + ": its number was given before");
  member.session_begun = now();
  robot.session = *session;
  robot.exchange->begin_session(*session);
  survey_.begin_frame(member.index, time());
}

void FaultyFleet::reissue(const AgentId& name, Robot& robot) {
  const exchange::NewNames names{
      robot.session, [&] { return draw_session(*robot.store, draws_); },
      [](const graph::Alignment& alignment) { return fleet_codec::quantised(alignment); }};
  const auto told = exchange::reissue_contested(*robot.exchange, *robot.store, names, clock(robot));
  trace(name.str() +
        (told ? " names " + std::to_string(*told) + " items anew" : ": " + told.error().message));
}

void FaultyFleet::on_sent(const Packet& packet) {
  monitor_.on_sent(packet);
  attacker_.overhear(packet);
}

std::shared_ptr<const messages::Message> FaultyFleet::on_air(const Packet& packet) {
  const bool lies = liars_.contains(packet.from);
  const messages::Message& message = packet.outgoing.message;
  const Bytes cdr = fleet_codec::encode(lies ? attacker_.lie(message, packet.from) : message);
  auto decoded = fleet_codec::decode_message(fleet_codec::topic_of(packet.outgoing), cdr);
  if (!decoded) {
    if (!lies)
      monitor_.note(Invariant::kOwnItems, packet.from, now(),
                    "nobody decodes it: " + decoded.error().message);
    return nullptr;
  }
  return std::make_shared<const messages::Message>(std::move(*decoded));
}

std::vector<Duration> FaultyFleet::arrivals(const Packet& packet, const AgentId& to) {
  const std::size_t from = member(packet.from).index, receiver = member(to).index;
  const auto reach = packet.outgoing.reach;
  if (reach == messages::Reach::kShortRange && mapping_) {
    const Eigen::Vector3d apart =
        survey_.T_enu_base(from, time()).translation() - survey_.T_enu_base(receiver, time()).translation();
    if (apart.norm() > kWifi) return {};
  }
  return links_.arrivals(from, receiver, reach);
}

void FaultyFleet::on_event(const AgentId& name, Robot& robot, const exchange::Event& event) {
  if (const auto line = trace_line(event)) trace(name.str() + ": " + *line);
  if (const auto* needed = std::get_if<exchange::CloudNeeded>(&event)) {
    const Status provided = robot.exchange->provide_cloud(
        needed->node, SyntheticSurvey::cloud_around(needed->node), clock(robot));
    if (!provided) monitor_.note(Invariant::kOwnItems, name, now(), provided.error().message);
  } else if (const auto* conflict = std::get_if<exchange::ItemConflict>(&event)) {
    monitor_.on_conflict(name, *conflict, now());
    if (conflict->id.agent == name) reissue(name, robot);
  } else if (std::holds_alternative<exchange::SessionTaken>(event)) {
    begin_session(name, robot);
  }
}

void FaultyFleet::on_received(const AgentId& name, Robot& robot,
                              const loop_closure::ReceivedCloud& received) {
  jobs_.add({now() + from_seconds(draws_.between(0.1, kMaxRegistration)), name, robot.session,
             received.candidate.pair()});
}

void FaultyFleet::map(const AgentId& name, Robot& robot) {
  const std::size_t index = member(name).index;
  const NodeId id{name, robot.store->next_node_seq(robot.session)};
  const auto made = survey_.node(index, id, time());
  if (!made) return;
  const auto put = robot.exchange->on_own_node(made->node, made->submap, clock(robot));
  if (!put) return;
  if (*put != store::Put::kAdded) {
    monitor_.note(Invariant::kOwnItems, name, now(),
                  "its own node " + to_string(id) + " is refused by its store");
    return;
  }
  survey_.on_stored(index, id, time());
  monitor_.on_made(made->node);
  trace(to_string(id) + " made");
}

void FaultyFleet::finish_jobs() {
  for (const RegistrationJob& job : jobs_.take_due(now())) {
    Robot& robot = this->robot(job.robot);
    const auto alignment = survey_.registration(job.pair, robot.store->next_alignment_seq(robot.session));
    const auto put = alignment ? robot.exchange->on_own_alignment(*alignment, clock(robot))
                               : Result<store::Put>(store::Put::kInvalid);
    if (put && *put == store::Put::kAdded) {
      trace(job.robot.str() + " aligned " + to_string(job.pair.ours) + " with " + to_string(job.pair.theirs));
      continue;
    }
    if (alignment && put)
      monitor_.note(Invariant::kOwnItems, job.robot, now(), "its own alignment is refused");
    robot.loop_closer->on_rejected(job.pair, clock(robot));
  }
}

void FaultyFleet::place(const AgentId& name, Robot& robot) {
  Member& member = this->member(name);
  const auto period = to_ns(now()) / kPlacementPeriod.count();
  const auto before = (to_ns(now()) - kTick.count()) / kPlacementPeriod.count();
  const std::size_t items = robot.store->nodes().size() + robot.store->alignments().size();
  if (period == before || items == member.placed_items) return;
  member.placed_items = items;
  robot.loop_closer->on_used_alignments(placement_of(robot, survey_.site()).used);
}

void FaultyFleet::attack() {
  for (const std::size_t number : attacks_) {
    const Fault& fault = scenario_.faults[number];
    if (!draws_.chance(fault.value * to_seconds(kTick))) continue;
    const auto injected = fault.kind == FaultKind::kStranger ? attacker_.stranger() : attacker_.forged();
    if (!injected) continue;
    if (fault.kind == FaultKind::kForged && !run_.signatures) monitor_.on_forged(*injected->message);
    trace("attacker to " + injected->to.str() + ": " + trace_line(*injected->message));
    deliver(injected->to, injected->reach, injected->message, kTick);
  }
}

void FaultyFleet::work() {
  while (next_change_ < changes_.size() && changes_[next_change_].at <= time())
    apply(changes_[next_change_++]);
  start_robots();
  attack();
  for (const auto& [name, entry] : robots()) {
    Robot& robot = this->robot(name);
    robot.events.clear();
    robot.received.clear();
    if (mapping_) map(name, robot);
    place(name, robot);
  }
  finish_jobs();
  if (now() < next_check_) return;
  next_check_ = now() + std::chrono::seconds(1);
  monitor_.check(robots(), now());
}

std::string FaultyFleet::why_not_converged() {
  if (robots().size() < members_.size()) return "a robot does not run";
  if (std::string why = fault_injection::why_not_converged(robots(), now()); !why.empty()) return why;
  return jobs_.empty() ? "" : "registrations are under way";
}

Outcome FaultyFleet::run() {
  const auto one = [this] {
    step();
    work();
  };
  while (time() < scenario_.mapping) one();
  mapping_ = false;
  trace("the last fault has ended");
  const Stamp last_fault = now();
  const bool completes = run_.invariants.contains(Invariant::kCompletes);
  const auto converged = [&] {
    return why_not_converged().empty() && (!completes || why_incomplete(robots(), now()).empty());
  };
  while (now() - last_fault < run_.settling && !converged()) one();
  Outcome outcome;
  outcome.converged_after = now() - last_fault;
  if (const std::string why = why_not_converged(); why.empty()) {
    for (const MapDifference& difference : map_differences(robots(), survey_.site()))
      monitor_.note(Invariant::kSameMap, difference.robot, now(), difference.what);
    if (const std::string what = why_incomplete(robots(), now()); !what.empty())
      monitor_.note(Invariant::kCompletes, {}, now(), what);
  } else {
    monitor_.note(Invariant::kConverges, {}, now(), why);
  }
  for (const auto& [name, robot] : robots()) {
    monitor_.check_held(name, *robot.store, now());
    monitor_.check_contents(name, *robot.store, now());
  }
  if (!robots().empty()) {
    outcome.nodes = robots().begin()->second.store->nodes().size();
    outcome.alignments = robots().begin()->second.store->alignments().size();
  }
  monitor_.fill(outcome);
  outcome.trace = trace_.take();
  return outcome;
}

}  // namespace fleetmap::fault_injection
