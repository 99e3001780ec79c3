#include "faulty_fleet.hpp"

#include <algorithm>
#include <utility>

#include "convergence.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/fleet_codec/topics.hpp"
#include "tick.hpp"

namespace fleetmap::fault_injection {
namespace {

constexpr double kWifi = 50.0;  // m

std::string backup_name(std::size_t fault) { return std::string(".").append(std::to_string(fault)); }

}  // namespace

FaultyFleet::FaultyFleet(const Scenario& scenario, const RunConfig& config,
                         const std::filesystem::path& folder)
    : SurveyingFleet(scenario, config, folder),
      scenario_(scenario),
      run_(config),
      links_(scenario.seed),
      attacker_(scenario.seed, config_.fleet, config.signatures),
      deception_(scenario.seed, config_),
      changes_(changes_of(scenario)),
      next_check_(now()) {
  anyone_reports_ = has_forgers();
}

bool FaultyFleet::has_forgers() const {
  return std::ranges::any_of(scenario_.faults,
                             [](const Fault& fault) { return fault.kind == FaultKind::kForged; });
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
  if (stops_robot(fault.kind)) stop_robot(name);
  harm(fault, name, number);
}

void FaultyFleet::harm(const Fault& fault, const AgentId& name, std::size_t number) {
  Member& member = this->member(name);
  switch (fault.kind) {
    case FaultKind::kClockStep:
      member.clock_offset = from_seconds(fault.value);
      return;
    case FaultKind::kLostStore:
      member.disk_intact = false;
      return lose_store(name);
    case FaultKind::kOldStore:
      member.disk_intact = false;
      return put_back_store(name, backup_name(number));
    case FaultKind::kDamagedStore:
      member.disk_intact = false;
      return damage_store(name, fault.value);
    case FaultKind::kManyStarts:
      return start_in_vain(name, static_cast<std::size_t>(fault.value));
    case FaultKind::kFullDisk:
      return member.disk->set_full(true);
    case FaultKind::kLiar:
      liars_.insert(name);
      return;
    case FaultKind::kCompromised:
      if (!compromised_) compromised_.emplace(scenario_.seed, name);
      trace(name.str() + " deceives by scheme " + to_string(compromised_->scheme()));
      ++deceptions_;
      return;
    case FaultKind::kNewOrigin:
      return restart_odometry(name);
    default:
      return;
  }
}

void FaultyFleet::end(const Fault& fault) {
  links_.end(fault);
  attacks_.erase(static_cast<std::size_t>(&fault - scenario_.faults.data()));
  if (fault.robots.empty()) return;
  const AgentId& name = name_of(fault.robots[0]);
  if (stops_robot(fault.kind) && --stopped_[name] == 0) member(name).start_at = now();
  if (fault.kind == FaultKind::kFullDisk) member(name).disk->set_full(false);
  if (fault.kind == FaultKind::kLiar) liars_.erase(liars_.find(name));
  if (fault.kind == FaultKind::kCompromised) --deceptions_;
}

void FaultyFleet::stop_robot(const AgentId& name) {
  ++stopped_[name];
  kill_robot(name);
}

void FaultyFleet::on_sent(const Packet& packet) {
  std::vector<AgentId> hearers;
  for (const auto& [name, robot] : robots()) {
    const std::size_t from = member(packet.from).index, to = member(name).index;
    if (from != to && !links_.cuts(from, to, messages::Reach::kLongRange)) hearers.push_back(name);
  }
  monitor_.on_sent(packet, hearers);
  attacker_.overhear(packet);
}

std::shared_ptr<const messages::Message> FaultyFleet::on_air(const Packet& packet) {
  const bool deceives = deceptions_ > 0 && packet.from == compromised_->self() && deception_.lies();
  const bool lies = deceives || liars_.contains(packet.from);
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

void FaultyFleet::attack() {
  for (const std::size_t number : attacks_) {
    const Fault& fault = scenario_.faults[number];
    if (!draws_.chance(fault.value * to_seconds(kTick))) continue;
    const auto injected = fault.kind == FaultKind::kStranger ? attacker_.stranger() : attacker_.forged();
    if (!injected) continue;
    if (fault.kind == FaultKind::kForged && !run_.signatures) monitor_.on_forged(*injected->message);
    inject(*injected, std::nullopt);
  }
}

void FaultyFleet::inject(const Attacker::Injected& injected, const std::optional<AgentId>& from) {
  trace("attacker to " + injected.to.str() + ": " + trace_line(*injected.message));
  deliver(injected.to, injected.reach, injected.message, kTick, from);
}

void FaultyFleet::deceive() {
  if (deceptions_ == 0 || !runs(compromised_->self())) return;
  const AgentId& self = compromised_->self();
  Robot& robot = this->robot(self);
  if (deception_.invents(kTick)) {
    const auto alignment =
        compromised_->invented(*robot.store, survey_, robot.store->next_alignment_seq(robot.session));
    if (alignment) (void)robot.exchange->on_own_alignment(*alignment, clock(robot));
  }
  for (const auto& injected : deception_.messages_of(*compromised_, *robot.store, survey_, attacker_, kTick))
    inject(injected, self);
}

void FaultyFleet::work() {
  while (next_change_ < changes_.size() && changes_[next_change_].at <= time())
    apply(changes_[next_change_++]);
  start_robots(mapping_);
  attack();
  deceive();
  survey(mapping_);
  if (now() < next_check_) return;
  next_check_ = now() + std::chrono::seconds(1);
  monitor_.check(robots(), now());
}

std::string FaultyFleet::why_not_converged() {
  if (robots().size() < member_count()) return "a robot does not run";
  if (std::string why = fault_injection::why_not_converged(robots(), now()); !why.empty()) return why;
  return registers() ? "registrations are under way" : "";
}

EndInput FaultyFleet::end_input() const {
  EndInput input{robots(), survey_.site(), now(), {}, false, {}};
  if (compromised_) input.compromised = {compromised_->self(), compromised_->is_gross()};
  input.anyone_forges = !run_.signatures && has_forgers();
  input.truth = [this](const NodeId& id) { return survey_.T_enu_node(id); };
  return input;
}

void FaultyFleet::check_end(Outcome& outcome) {
  if (const std::string why = why_not_converged(); why.empty()) {
    check_maps(end_input(), monitor_, outcome);
  } else {
    monitor_.note(Invariant::kConverges, {}, now(), why);
  }
  check_stores(end_input(), monitor_);
  if (!robots().empty()) {
    outcome.nodes = robots().begin()->second.store->nodes().size();
    outcome.alignments = robots().begin()->second.store->alignments().size();
  }
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
  while (now() - last_fault < run_.convergence_timeout && !converged()) one();
  Outcome outcome;
  outcome.converged_after = now() - last_fault;
  check_end(outcome);
  monitor_.fill(outcome);
  outcome.trace = trace_.take();
  return outcome;
}

}  // namespace fleetmap::fault_injection
