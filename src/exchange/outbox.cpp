#include "outbox.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace fleetmap::exchange {
namespace {

using messages::AgentStatus;
using messages::Reach;

std::vector<AgentId> others_of(const std::vector<AgentId>& fleet, const AgentId& self) {
  std::vector<AgentId> others;
  std::ranges::remove_copy(fleet, std::back_inserter(others), self);
  return others;
}

}  // namespace

Outgoing over_short_range(Message message) {
  auto to = recipient_of(message);
  return {Reach::kShortRange, std::move(to), std::move(message)};
}

Outbox::Outbox(const AgentId& self, const ExchangeConfig& config)
    : self_(self),
      on_radio_(config.on_radio.begin(), config.on_radio.end()),
      queue_(config.long_range, others_of(config.on_radio, self), config.payload_size) {
  const std::set<AgentId> fleet(config.fleet.begin(), config.fleet.end());
  std::ranges::set_difference(fleet, on_radio_, std::inserter(elsewhere_, elsewhere_.end()));
}

bool Outbox::set_receivers(std::set<AgentId> near, std::set<AgentId> present) {
  const bool newcomers = !std::ranges::includes(near_, near);
  near_ = std::move(near);
  present_ = std::move(present);
  return newcomers;
}

void Outbox::broadcast(Priority priority, Message message) {
  if (!near_.empty()) to_near_.push_back(message);
  if (priority == Priority::kSafety) return queue_.push(priority, std::move(message));
  // An absent robot gets the status alone, by which two robots that meet notice each other.
  const bool to_absent = std::holds_alternative<AgentStatus>(message);
  std::set<AgentId> receivers;
  for (const AgentId& agent : on_radio_) {
    if (agent != self_ && !near_.contains(agent) && (to_absent || present_.contains(agent)))
      receivers.insert(agent);
  }
  queue_.push_to(receivers, priority, std::move(message));
}

std::vector<Outgoing> Outbox::take_short_range() {
  std::vector<Outgoing> out;
  for (Message& message : std::exchange(to_near_, {})) out.push_back(over_short_range(std::move(message)));
  for (Outgoing& diverted : queue_.take_for(near_)) {
    diverted.reach = Reach::kShortRange;
    out.push_back(std::move(diverted));
  }
  queue_.take_for(elsewhere_);  // robots on another radio would not receive them
  return out;
}

}  // namespace fleetmap::exchange
