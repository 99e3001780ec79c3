#include "virtual_fleet.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "fleetmap/agent/navigator.hpp"
#include "fleetmap/core/cpu_time.hpp"
#include "fleetmap/core/paths.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/fleet_codec/topics.hpp"
#include "fleetmap/output/results.hpp"
#include "fleetmap/planning/mission/mission_complete.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "recordings/sample_player.hpp"
#include "robot/sensor_recorder.hpp"
#include "twin_truth.hpp"

namespace fleetmap::apps {
namespace {

constexpr Duration kStep = std::chrono::seconds(1);
constexpr Duration kReportEvery = std::chrono::seconds(30);

}  // namespace

Result<std::unique_ptr<VirtualFleet>> VirtualFleet::create(config::FleetConfig config,
                                                           std::unique_ptr<FleetFeed> feed,
                                                           const std::filesystem::path& out,
                                                           const RecordOptions& record,
                                                           std::uint16_t first_session) {
  std::unique_ptr<VirtualFleet> fleet(new VirtualFleet(std::move(config), std::move(feed)));
  if (const Status added = fleet->add_agents(out, record, first_session); !added)
    return tl::unexpected(added.error());
  return fleet;
}

Status VirtualFleet::add_agents(const std::filesystem::path& out, const RecordOptions& record,
                                std::uint16_t first_session) {
  config_.network.start = feed_->start();
  auto network = bus::LocalNetwork::create(config_.network);
  if (!network) return tl::unexpected(network.error());
  network_ = std::move(*network);
  schedule_blackouts();
  for (std::size_t k = 0; k < config_.members.size(); ++k) {
    agent::AgentConfig& config = config_.members[k].agent;
    config.directory = out / config.id.str();
    if (origin_) config.site_origin = origin_;
    // Sessions are numbered, so that the same run gives the same items; numbers that the store already has
    // are skipped.
    config.draw_session = [session = first_session]() mutable { return session++; };
    if (is_there(config.directory / "store.db")) {
      return failure(config.directory.string() +
                     ": holds an earlier run, or what is left of one that was cut off; a run starts anew, "
                     "give another --out or delete it");
    }
    Member& member = members_.emplace_back();
    member.id = config.id;
    if (!record.folder.empty()) {
      auto bag =
          recording::BagWriter::create(std::filesystem::path(record.folder) / config.id.str(), record.format);
      if (!bag) return tl::unexpected(bag.error());
      member.bag.emplace(std::move(*bag));
    }
    if (const Status started = start_agent(k); !started) return started;
  }
  return {};
}

Status VirtualFleet::start_agent(std::size_t member) {
  Member& self = members_[member];
  self.bus = &network_->add_robot(self.id);
  auto agent = agent::Agent::create(config_.members[member].agent, *self.bus);
  if (!agent) return tl::unexpected(agent.error());
  self.agent = std::move(*agent);
  self.rest_frozen = false;
  if (self.bag && config_.members[member].ros.publish) {
    self.outputs = std::make_unique<OutputRecording>(
        *self.agent, *self.bus, config_.members[member].ros,
        [this, member](const bus::Topic& topic, const Bytes& cdr) { record(member, topic, cdr); });
  }
  return {};
}

void VirtualFleet::deliver(std::size_t member, const recording::Sample& sample, Stamp stamp) {
  Member& self = members_[member];
  if (!self.agent) return;
  const EncodedSample encoded = encode(sample, self.agent->config().perception.topics);
  self.bag_delay = network_->now() - stamp;
  self.bus->publish(encoded.topic, encoded.cdr);
  record(member, encoded.topic, encoded.cdr);
}

void VirtualFleet::record(std::size_t member, const bus::Topic& topic, const Bytes& cdr) {
  Member& self = members_[member];
  if (!self.bag) return;
  const Status written =
      self.bag->write(topic.name, topic.type, network_->now() - self.bag_delay, cdr, durability_of(topic));
  if (!written) error_ = written.error().message;
}

void VirtualFleet::connect_base(std::size_t member) {
  Member& self = members_[member];
  self.base.push_back(self.bus->subscribe(ros_codec::topics::cmd_vel(), [this, member](const Bytes& cdr) {
    const auto command = ros_codec::decode<ros_codec::VelocityCommand>(cdr);
    if (command) feed_->command(member, command->forward_speed, command->yaw_rate);
  }));
  if (!feed_->guide(member)) return;
  self.base.push_back(self.bus->every(kGuidePeriod, [this, member] {
    const auto pose = feed_->guide(member);
    if (pose) members_[member].bus->publish(fleet_codec::topics::guide_pose(), fleet_codec::encode(*pose));
  }));
}

Status VirtualFleet::begin() {
  for (std::size_t k = 0; k < members_.size(); ++k) connect_base(k);
  schedule_power();
  if (has_mission()) completion_.emplace();
  return feed_->begin(*network_, [this](std::size_t member, const recording::Sample& sample, Stamp stamp) {
    deliver(member, sample, stamp);
  });
}

bool VirtualFleet::has_mission() const {
  return std::ranges::any_of(config_.members, [](const auto& m) { return m.agent.navigator != nullptr; });
}

void VirtualFleet::end_mission(Duration elapsed) {
  if (!has_mission() || mission_ended_) return;
  const bool done = std::ranges::all_of(members_, [](const Member& m) {
    if (!m.agent) return m.lost;  // who comes back has something to bring
    return m.agent->navigator() == nullptr || m.agent->navigator()->done();
  });
  const bool late = config_.twin && elapsed > from_seconds(config_.twin->max_time);
  if (!done && !late) return;
  if (!done) spdlog::warn("max_time is up: robots are stopped before the mission's end");
  mission_ended_ = true;
  feed_->stop();
}

bool VirtualFleet::all_driven() const {
  return std::ranges::all_of(members_, [](const Member& m) {
    return !m.agent || m.agent->navigator() == nullptr || m.agent->navigator()->all_rows_driven();
  });
}

/// The rows that were given up and not driven, once for each robot that has a reason.
std::vector<Completion::Abandoned> VirtualFleet::abandoned_rows() const {
  std::vector<Completion::Abandoned> rows;
  for (const Member& member : members_) {
    if (!member.agent || member.agent->navigator() == nullptr) continue;
    for (auto& row : member.agent->navigator()->status().abandoned) {
      const bool listed = std::ranges::find(rows, row.row, &Completion::Abandoned::row) != rows.end();
      if (row.why.empty() && listed) continue;
      std::erase_if(rows, [&](const auto& other) { return other.row == row.row && other.why.empty(); });
      rows.push_back({row.row, member.id, std::move(row.why)});
    }
  }
  return rows;
}

void VirtualFleet::note_completion(Duration elapsed) {
  if (!completion_ || completion_->completed) return;
  const double now = to_seconds(elapsed);
  std::vector<AgentId> agents;
  std::vector<planning::PairAlignment> pairs;
  const store::SeqSet* nodes = nullptr;
  bool shared = true;
  for (const Member& member : members_) {
    if (member.lost) continue;
    agents.push_back(member.id);
    if (!member.agent) {
      completion_->why_not = member.id.str() + " is switched off";
      return;
    }
    const store::Store& store = member.agent->store();
    shared &= nodes == nullptr || store.node_set() == *nodes;
    nodes = &store.node_set();
    for (const auto& [id, alignment] : store.alignments()) {
      if (alignment.computed_by == member.id && !alignment.ambiguous())
        pairs.push_back({alignment.i.agent, alignment.j.agent, alignment.best().rmse});
    }
  }
  const bool driven = all_driven();
  if (driven && !completion_->rows_driven) completion_->rows_driven = now;
  if (!completion_->aligned && planning::mapping_complete(agents, pairs, true, graph::kGoodRmse).complete)
    completion_->aligned = now;
  const planning::Completeness complete = planning::mapping_complete(agents, pairs, shared, graph::kGoodRmse);
  completion_->why_not = driven ? complete.why_not : "rows are left to drive";
  if (driven && complete.complete) completion_->completed = now;
}

void VirtualFleet::update_states() {
  for (std::size_t k = 0; k < members_.size(); ++k) {
    const AgentId& id = members_[k].id;
    if (const auto share = feed_->battery(k); share && members_[k].bus != nullptr) {
      members_[k].bus->publish(ros_codec::topics::battery(),
                               ros_codec::encode(sensor::Battery{network_->now(), *share}));
    }
    if (const auto position = position_of(k)) {
      members_[k].position = *position;
      network_->set_position(id, *position);
    } else if (feed_->ended(k) && !members_[k].position) {
      // The position of a recording is unknown. Once it has ended the robot counts as beside the others, so
      // that maps can be exchanged.
      const auto known =
          std::ranges::find_if(members_, [](const Member& m) { return m.position.has_value(); });
      network_->set_position(id, known == members_.end() ? bus::EnuPosition{} : *known->position);
    }
  }
}

std::optional<bus::EnuPosition> VirtualFleet::position_of(std::size_t member) const {
  if (const auto truth = feed_->position(member)) return truth;
  const Member& self = members_[member];
  const auto G = self.agent ? self.agent->perception().global_pose() : std::nullopt;
  if (!G || !origin_) return std::nullopt;
  const Eigen::Vector3d p = LocalFrame(*origin_).to_enu(G->position);
  return bus::EnuPosition{p.x(), p.y(), p.z()};
}

void VirtualFleet::update_page() {
  if (!page_) return;
  std::vector<VirtualPage::Shown> shown;
  for (const Member& member : members_)
    if (member.agent) shown.push_back({member.agent.get(), member.bus});
  page_->update(shown);
}

bool VirtualFleet::playing() const {
  for (std::size_t k = 0; k < members_.size(); ++k) {
    if (!feed_->ended(k)) return true;
  }
  return false;
}

bool VirtualFleet::exchange_ended() {
  bool all = true;
  for (std::size_t k = 0; k < members_.size(); ++k) {
    Member& member = members_[k];
    const bool ended = feed_->ended(k);
    if (!member.agent) {
      all &= ended || member.lost;
      continue;
    }
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
    if (!member.agent) {
      spdlog::info("{:.0f} s {}: switched off", to_seconds(elapsed), member.id.str());
      continue;
    }
    const store::Store& store = member.agent->store();
    const agent::Navigator* navigator = member.agent->navigator();
    spdlog::info("{:.0f} s {}: {}{} nodes, {} alignments, {} submaps", to_seconds(elapsed), member.id.str(),
                 navigator ? std::string(messages::to_string(navigator->status().state)) + ", " : "",
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
    update_page();
    end_mission(network_->now() - start);
    note_completion(network_->now() - start);
    if (playing()) last_sample = network_->now();
    outcome.exchange_ended = exchange_ended();
    if (outcome.exchange_ended || network_->now() - last_sample > from_seconds(config_.exchange_timeout))
      break;
    if (network_->now() < next_report) continue;
    next_report += kReportEvery;
    report_progress(network_->now() - start);
  }
  if (page_) page_->forget_agents();
  if (!error_.empty()) return failure(error_);
  outcome.virtual_time = network_->now() - start;
  outcome.exchange_time = network_->now() - last_sample;
  if (completion_) completion_->abandoned = abandoned_rows();
  outcome.completion = completion_;
  outcome.links = network_->link_use();
  outcome.origin_known = origin_.has_value();
  if (origin_) outcome.origin = *origin_;
  outcome.feed_seconds = feed_->cpu_seconds();
  for (std::size_t k = 0; k < members_.size(); ++k) {
    outcome.work_seconds += members_[k].work_before;
    if (members_[k].agent) outcome.work_seconds += members_[k].agent->work_seconds();
    auto result = finish(k);
    if (!result) return tl::unexpected(result.error());
    outcome.agents.push_back(std::move(*result));
  }
  outcome.results_seconds = results_seconds_;
  return outcome;
}

Result<output::Results> VirtualFleet::write_results_of(store::Store& store,
                                                       const output::ResultsConfig& config) {
  const CpuTimer timer(results_seconds_);
  const store::SubmapLoader load = previews_ ? previews_->loader(store) : store::SubmapLoader();
  auto written = output::write_results(store, config, maps_, load);
  if (written) maps_.push_back(written->map);
  return written;
}

Result<FleetOutcome::AgentOutcome> VirtualFleet::finish(std::size_t member) {
  Member& self = members_[member];
  if (!self.agent) return results_of_store(member);
  // Work under way uses the agent and its store.
  self.agent->stop();
  network_->finish_work(self.id);
  self.outputs.reset();
  FleetOutcome::AgentOutcome result;
  result.id = self.id;
  result.directory = self.agent->config().directory;
  auto written = write_results_of(self.agent->store(), self.agent->config().results());
  if (written) {
    result.results = std::move(*written);
  } else {
    result.problem = written.error().message;
  }
  if (result.problem.empty()) result.problem = feed_->problem(member);
  result.recording = feed_->counters(member);
  result.recording_findings = feed_->findings(member);
  if (self.bag) {
    if (const Status closed = self.bag->close(); !closed) return tl::unexpected(closed.error());
  }
  result.agent = std::move(self.agent);
  return result;
}

}  // namespace fleetmap::apps
