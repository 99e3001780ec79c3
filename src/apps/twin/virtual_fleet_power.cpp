// Robots that are switched off and on during a run, and radios that pass nothing.
#include <spdlog/spdlog.h>

#include "fleetmap/output/results.hpp"
#include "virtual_fleet.hpp"

namespace fleetmap::apps {

void VirtualFleet::schedule_blackouts() {
  const Stamp start = feed_->start();
  for (const config::RadioBlackout& b : config_.blackouts) {
    network_->add_blackout({b.link, start + from_seconds(b.from), start + from_seconds(b.until), b.agent});
  }
}

void VirtualFleet::schedule_power() {
  const Stamp start = feed_->start();
  for (std::size_t k = 0; k < members_.size(); ++k) {
    for (const config::SwitchedOff& off : config_.members[k].switched_off) {
      network_->at(start + from_seconds(off.from), [this, k, off] { switch_off(k, !off.until); });
      if (off.until) network_->at(start + from_seconds(*off.until), [this, k] { switch_on(k); });
    }
  }
}

void VirtualFleet::switch_off(std::size_t member, bool for_ever) {
  Member& self = members_[member];
  self.lost = for_ever;
  feed_->switch_power(member, false);
  self.base.clear();
  // Work under way uses the agent and its store.
  network_->finish_work(self.id);
  if (page_) page_->forget_agents();
  if (self.agent) self.work_before += self.agent->work_seconds();
  self.outputs.reset();
  self.agent.reset();
  self.bus = nullptr;
  network_->remove_robot(self.id);
  spdlog::info("{} is switched off", self.id.str());
}

void VirtualFleet::switch_on(std::size_t member) {
  Member& self = members_[member];
  spdlog::info("{} is switched on again", self.id.str());
  if (const Status started = start_agent(member); !started) {
    error_ = started.error().message;
    return;
  }
  connect_base(member);
  feed_->switch_power(member, true);
}

FleetOutcome::AgentOutcome VirtualFleet::results_of_store(std::size_t member) {
  Member& self = members_[member];
  const agent::AgentConfig& config = config_.members[member].agent;
  FleetOutcome::AgentOutcome result;
  result.id = self.id;
  result.directory = config.directory;
  result.recording = feed_->counters(member);
  result.recording_findings = feed_->findings(member);
  if (self.bag) {
    if (const Status closed = self.bag->close(); !closed) result.problem = closed.error().message;
  }
  auto store = store::Store::open(config.directory / "store.db", self.id, config.store);
  if (!store) {
    result.problem = store.error().message;
    return result;
  }
  result.store.emplace(std::move(*store));
  auto written = write_results_of(*result.store, config.results());
  if (written) {
    result.results = std::move(*written);
  } else if (!result.store->nodes().empty()) {
    result.problem = written.error().message;
  }
  return result;
}

}  // namespace fleetmap::apps
