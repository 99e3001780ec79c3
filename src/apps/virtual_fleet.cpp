#include "virtual_fleet.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "fleetmap/agent/navigator.hpp"
#include "fleetmap/planning/mission_complete.hpp"
#include "fleetmap/wire/sensors.hpp"
#include "fleetmap/wire/topics.hpp"
#include "sample_player.hpp"

namespace fleetmap::apps {
namespace {

constexpr Duration kStep = std::chrono::seconds(1);
constexpr Duration kReportEvery = std::chrono::seconds(30);

}  // namespace

Result<std::unique_ptr<VirtualFleet>> VirtualFleet::create(
    config::FleetConfig config, std::unique_ptr<FleetFeed> feed, const std::filesystem::path& out,
    const std::optional<std::filesystem::path>& record) {
  std::unique_ptr<VirtualFleet> fleet(new VirtualFleet(std::move(config), std::move(feed)));
  if (const Status added = fleet->add_agents(out, record); !added) return tl::unexpected(added.error());
  return fleet;
}

Status VirtualFleet::add_agents(const std::filesystem::path& out,
                                const std::optional<std::filesystem::path>& record) {
  config_.network.start = feed_->start();
  auto network = bus::LocalNetwork::create(config_.network);
  if (!network) return tl::unexpected(network.error());
  network_ = std::move(*network);
  for (config::FleetConfig::Member& source : config_.members) {
    agent::AgentConfig& config = source.agent;
    config.directory = out / config.id.str();
    if (origin_) config.site_origin = origin_;
    std::error_code error;
    if (std::filesystem::exists(config.directory / "store.db", error)) {
      return failure(config.directory.string() +
                     ": holds the result of an earlier run; give another --out or delete it");
    }
    Member member;
    member.bus = &network_->add_robot(config.id);
    auto agent = agent::Agent::create(config, *member.bus);
    if (!agent) return tl::unexpected(agent.error());
    member.agent = std::move(*agent);
    if (record) {
      auto bag = recording::BagWriter::create(*record / config.id.str());
      if (!bag) return tl::unexpected(bag.error());
      member.bag.emplace(std::move(*bag));
    }
    members_.push_back(std::move(member));
  }
  return {};
}

void VirtualFleet::deliver(std::size_t member, const recording::Sample& sample, Stamp stamp) {
  Member& self = members_[member];
  const EncodedSample encoded = encode(sample, self.agent->config().perception.topics);
  self.bus->publish(encoded.topic, encoded.cdr);
  if (!self.bag) return;
  const Status written = self.bag->write(encoded.topic.name, encoded.topic.type, stamp, encoded.cdr);
  if (!written) error_ = written.error().message;
}

Status VirtualFleet::begin() {
  for (std::size_t k = 0; k < members_.size(); ++k) {
    members_[k].commands = members_[k].bus->subscribe(wire::topics::cmd_vel(), [this, k](const Bytes& cdr) {
      const auto command = wire::decode<wire::VelocityCommand>(cdr);
      if (command) feed_->command(k, command->forward_speed, command->yaw_rate);
    });
  }
  if (has_mission()) completion_.emplace();
  return feed_->begin(*network_, [this](std::size_t member, const recording::Sample& sample, Stamp stamp) {
    deliver(member, sample, stamp);
  });
}

bool VirtualFleet::has_mission() const {
  return std::ranges::any_of(members_, [](const Member& m) { return m.agent->navigator() != nullptr; });
}

void VirtualFleet::end_mission(Duration elapsed) {
  if (!has_mission() || mission_ended_) return;
  const bool done = std::ranges::all_of(members_, [](const Member& m) {
    return m.agent->navigator() == nullptr || m.agent->navigator()->done();
  });
  const bool late = config_.twin && elapsed > from_seconds(config_.twin->max_time);
  if (!done && !late) return;
  if (!done) spdlog::warn("max_time is up: robots are stopped before the mission's end");
  mission_ended_ = true;
  feed_->stop();
}

void VirtualFleet::note_completion(Duration elapsed) {
  if (!completion_ || completion_->completed) return;
  const double now = to_seconds(elapsed);
  std::vector<AgentId> agents;
  std::vector<planning::PairAlignment> pairs;
  bool shared = true, driven = true;
  for (const Member& member : members_) {
    const store::Store& store = member.agent->store();
    agents.push_back(member.agent->config().id);
    shared &= store.node_set() == members_.front().agent->store().node_set();
    driven &= member.agent->navigator() == nullptr || member.agent->navigator()->all_rows_driven();
    for (const auto& [id, alignment] : store.alignments()) {
      if (alignment.computed_by == member.agent->config().id)
        pairs.push_back({alignment.i.agent, alignment.j.agent, alignment.rmse});
    }
  }
  if (driven && !completion_->rows_driven) completion_->rows_driven = now;
  if (!completion_->aligned && planning::mapping_complete(agents, pairs, true, graph::kGoodRmse).complete)
    completion_->aligned = now;
  const planning::Completeness complete = planning::mapping_complete(agents, pairs, shared, graph::kGoodRmse);
  completion_->why_not = driven ? complete.why_not : "rows are left to drive";
  if (driven && complete.complete) completion_->completed = now;
}

void VirtualFleet::update_states() {
  for (std::size_t k = 0; k < members_.size(); ++k) {
    const AgentId& id = members_[k].agent->config().id;
    if (const auto share = feed_->battery(k)) {
      members_[k].bus->publish(wire::topics::battery(),
                               wire::encode(sensor::Battery{network_->now(), *share}));
    }
    if (const auto truth = feed_->position(k)) {
      network_->set_position(id, *truth);
      continue;
    }
    const auto G = members_[k].agent->perception().global_pose();
    if (!G || !origin_) continue;
    const Eigen::Vector3d p = LocalFrame(*origin_).to_enu(G->position);
    network_->set_position(id, {p.x(), p.y(), p.z()});
  }
}

bool VirtualFleet::playing() const {
  for (std::size_t k = 0; k < members_.size(); ++k) {
    if (!feed_->ended(k)) return true;
  }
  return false;
}

bool VirtualFleet::settled() {
  bool all = true;
  for (std::size_t k = 0; k < members_.size(); ++k) {
    Member& member = members_[k];
    const bool ended = feed_->ended(k);
    if (ended && !member.rest_frozen && member.agent->perception().idle()) {
      member.agent->freeze_rest();
      member.rest_frozen = true;
      all = false;
    }
    all &= ended && member.rest_frozen && member.agent->idle() && member.agent->complete() &&
           member.agent->fleet_caught_up();
  }
  return all;
}

void VirtualFleet::report_progress(Duration elapsed) const {
  for (const Member& member : members_) {
    const store::Store& store = member.agent->store();
    const agent::Navigator* navigator = member.agent->navigator();
    spdlog::info("{:.0f} s {}: {}{} nodes, {} alignments, {} submaps", to_seconds(elapsed),
                 member.agent->config().id.str(),
                 navigator ? std::string(planning::to_string(navigator->status().state)) + ", " : "",
                 store.nodes().size(), store.alignments().size(), store.submap_set().size());
  }
}

Result<FleetOutcome> VirtualFleet::run() {
  const Stamp start = network_->now();
  if (const Status begun = begin(); !begun) return tl::unexpected(begun.error());
  FleetOutcome outcome;
  Stamp last_sample = start;
  Stamp next_report = start + kReportEvery;
  while (error_.empty()) {
    network_->run_until(network_->now() + kStep);
    update_states();
    end_mission(network_->now() - start);
    note_completion(network_->now() - start);
    if (playing()) last_sample = network_->now();
    outcome.settled = settled();
    if (outcome.settled || network_->now() - last_sample > from_seconds(config_.settle_time)) break;
    if (network_->now() < next_report) continue;
    next_report += kReportEvery;
    report_progress(network_->now() - start);
  }
  if (!error_.empty()) return failure(error_);
  outcome.virtual_time = network_->now() - start;
  outcome.settle_time = network_->now() - last_sample;
  outcome.completion = completion_;
  outcome.links = network_->link_use();
  outcome.origin_known = origin_.has_value();
  if (origin_) outcome.origin = *origin_;
  for (std::size_t k = 0; k < members_.size(); ++k) {
    auto result = finish(k);
    if (!result) return tl::unexpected(result.error());
    outcome.agents.push_back(std::move(*result));
  }
  return outcome;
}

Result<FleetOutcome::AgentOutcome> VirtualFleet::finish(std::size_t member) {
  Member& self = members_[member];
  // Work under way uses the agent and its store.
  self.agent->stop();
  network_->finish_work(self.agent->config().id);
  FleetOutcome::AgentOutcome result;
  auto written = agent::write_results(self.agent->store(), self.agent->config());
  if (written) {
    result.results = std::move(*written);
  } else {
    result.problem = written.error().message;
  }
  if (result.problem.empty()) result.problem = feed_->problem(member);
  result.recording = feed_->counters(member);
  if (self.bag) {
    if (const Status closed = self.bag->close(); !closed) return tl::unexpected(closed.error());
  }
  result.agent = std::move(self.agent);
  return result;
}

}  // namespace fleetmap::apps
