#include "radio.hpp"

#include <algorithm>

namespace fleetmap::bus {

LinkUse& Radio::use_of(const Transmission& transmission) {
  LinkUse& use = use_[{transmission.from, transmission.topic.name}];
  use.agent = transmission.from;
  use.link = link_;
  use.topic = transmission.topic.name;
  return use;
}

void Radio::send(Transmission transmission) {
  auto& queue = waiting_[transmission.from];
  if (queue.size() >= config_.queue_capacity) {
    ++use_of(queue.front()).dropped;
    dropped_(queue.front());
    queue.pop_front();
  }
  queue.push_back(std::move(transmission));
  if (!busy_) start_next();
}

Radio::Attempt Radio::attempt(const Transmission& transmission) {
  const auto& profiles = config_.reliable_profiles;
  const bool reliable =
      std::find(profiles.begin(), profiles.end(), transmission.topic.profile) != profiles.end();
  Attempt result;
  for (std::size_t i = datagrams(transmission.cdr->size(), config_.overhead); i > 0; --i) {
    bool lost = true;
    do {
      ++result.datagrams_sent;
      // The top 53 bits as a number in [0, 1): the same on every platform, unlike the standard distributions.
      lost = static_cast<double>(random_() >> 11) * 0x1p-53 < config_.loss;
    } while (lost && reliable);
    result.arrived = result.arrived && !lost;
  }
  return result;
}

void Radio::start_next() {
  // The first robot with something to send after the one whose turn it was.
  auto turn = waiting_.upper_bound(last_turn_);
  for (std::size_t i = 0; i <= waiting_.size(); ++i) {
    if (turn == waiting_.end()) turn = waiting_.begin();
    if (turn == waiting_.end()) return;
    if (!turn->second.empty()) break;
    ++turn;
  }
  if (turn == waiting_.end() || turn->second.empty()) return;
  last_turn_ = turn->first;
  auto transmission = std::make_shared<const Transmission>(std::move(turn->second.front()));
  turn->second.pop_front();

  const Attempt attempt = this->attempt(*transmission);
  const std::size_t count = datagrams(transmission->cdr->size(), config_.overhead);
  const double mean_bytes = static_cast<double>(wire_bytes(transmission->cdr->size(), config_.overhead)) /
                            static_cast<double>(count);
  const double bytes = mean_bytes * static_cast<double>(attempt.datagrams_sent);
  const Duration airtime = from_seconds(bytes * 8.0 / config_.rate_bit_s);
  LinkUse& use = use_of(*transmission);
  ++use.copies;
  use.wire_bytes += static_cast<std::uint64_t>(bytes);
  use.airtime += airtime;
  busy_ = true;
  events_.at(events_.now() + airtime, [this, transmission, arrived = attempt.arrived] {
    busy_ = false;
    finish(*transmission, arrived);
    if (!busy_) start_next();
  });
}

void Radio::finish(const Transmission& transmission, bool arrived) {
  HeardCopies& heard = heard_[transmission.to][transmission.from];
  heard.link = link_;
  heard.from = transmission.from;
  if (!arrived || !reachable_(transmission.from, transmission.to)) {
    ++use_of(transmission).lost;
    ++heard.lost;
    return;
  }
  ++heard.messages;
  heard.bytes += wire_bytes(transmission.cdr->size(), config_.overhead);
  heard.delay += events_.now() + config_.delay - transmission.published;
  events_.at(events_.now() + config_.delay, [this, transmission] { deliver_(transmission); });
}

std::vector<HeardCopies> Radio::take_heard(const AgentId& to) {
  std::vector<HeardCopies> all;
  for (const auto& [from, heard] : heard_[to]) all.push_back(heard);
  heard_.erase(to);
  return all;
}

std::vector<LinkUse> Radio::use() const {
  std::vector<LinkUse> all;
  for (const auto& [key, use] : use_) all.push_back(use);
  return all;
}

}  // namespace fleetmap::bus
