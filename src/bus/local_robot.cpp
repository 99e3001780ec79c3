#include "local_robot.hpp"

#include <stdexcept>
#include <utility>

namespace fleetmap::bus {

LocalRobot::LocalRobot(EventQueue& events, std::size_t onboard_queue_capacity, Transmit transmit)
    : events_(events), onboard_queue_capacity_(onboard_queue_capacity), transmit_(std::move(transmit)) {}

Stamp LocalRobot::now() const { return events_.now(); }

LocalRobot::TopicState& LocalRobot::state_of(const Topic& topic) {
  auto [entry, fresh] = state_->topics.try_emplace({topic.link, topic.name});
  if (fresh) {
    entry->second.topic = topic;
    entry->second.stats.topic = topic.name;
    entry->second.stats.link = topic.link;
  } else if (entry->second.topic.type != topic.type || entry->second.topic.profile != topic.profile) {
    throw std::logic_error("topic " + topic.name + " is used with two types or profiles");
  }
  return entry->second;
}

void LocalRobot::publish(const Topic& topic, const Bytes& cdr) {
  TopicState& state = state_of(topic);
  ++state.stats.sent_messages;
  state.stats.sent_bytes += cdr.size();
  auto shared = std::make_shared<const Bytes>(cdr);
  if (topic.link == Link::kOnboard) {
    publish_onboard(state, std::move(shared));
  } else {
    transmit_(topic, std::move(shared));
  }
}

void LocalRobot::publish_onboard(TopicState& state, std::shared_ptr<const Bytes> cdr) {
  if (state.subscribers.empty()) return;
  if (state.pending - state.skip >= onboard_queue_capacity_) {
    ++state.skip;
    ++state.stats.dropped_messages;
  }
  ++state.pending;
  events_.post([owner = std::weak_ptr<State>(state_), &state, cdr = std::move(cdr)] {
    const auto alive = owner.lock();
    if (!alive) return;
    --state.pending;
    if (state.skip > 0) {
      --state.skip;
      return;
    }
    run_subscribers(state, *cdr);
  });
}

void LocalRobot::run_subscribers(TopicState& state, const Bytes& cdr) {
  if (state.subscribers.empty()) return;
  ++state.stats.received_messages;
  state.stats.received_bytes += cdr.size();
  const auto subscribers = state.subscribers;  // a callback may subscribe or cancel
  for (const auto& subscriber : subscribers) {
    if (subscriber->active) subscriber->on_message(cdr);
  }
}

void LocalRobot::deliver(const Topic& topic, const std::shared_ptr<const Bytes>& cdr) {
  const auto alive = state_;  // a callback may switch this robot off
  const auto entry = alive->topics.find({topic.link, topic.name});
  if (entry != alive->topics.end()) run_subscribers(entry->second, *cdr);
}

Handle LocalRobot::subscribe(const Topic& topic, OnMessage on_message) {
  TopicState& state = state_of(topic);
  auto subscriber = std::make_shared<Subscriber>(Subscriber{std::move(on_message)});
  state.subscribers.push_back(subscriber);
  return Handle([owner = std::weak_ptr<State>(state_), &state, subscriber] {
    subscriber->active = false;
    if (const auto alive = owner.lock()) std::erase(state.subscribers, subscriber);
  });
}

Handle LocalRobot::every(Duration period, std::function<void()> callback) {
  if (period <= Duration::zero()) throw std::logic_error("a timer's period must be > 0");
  auto timer = std::make_shared<Timer>(Timer{period, std::move(callback)});
  schedule(events_, timer, state_, events_.now() + period);
  return Handle([timer] { timer->active = false; });
}

void LocalRobot::schedule(EventQueue& events, const std::shared_ptr<Timer>& timer,
                          const std::weak_ptr<State>& owner, Stamp stamp) {
  events.at(stamp, [&events, timer, owner, stamp] {
    if (!timer->active || owner.expired()) return;
    timer->callback();
    if (timer->active) schedule(events, timer, owner, stamp + timer->period);
  });
}

void LocalRobot::offload(Lane, std::function<void()> work, std::function<void()> done) {
  const std::weak_ptr<State> owner = state_;
  EventQueue& events = events_;
  events.post([&events, owner, work = std::move(work), done = std::move(done)]() mutable {
    if (owner.expired()) return;
    work();
    events.post([owner, done = std::move(done)] {
      if (!owner.expired()) done();
    });
  });
}

std::vector<TopicStats> LocalRobot::stats() const {
  std::vector<TopicStats> all;
  for (const auto& [key, state] : state_->topics) all.push_back(state.stats);
  return all;
}

bool LocalRobot::subscribes(const Topic& topic) const {
  const auto entry = state_->topics.find({topic.link, topic.name});
  if (entry == state_->topics.end() || entry->second.subscribers.empty()) return false;
  if (entry->second.topic.type != topic.type) {
    throw std::logic_error("topic " + topic.name + " is used with two types");
  }
  return true;
}

void LocalRobot::count_drop(const Topic& topic) { ++state_of(topic).stats.dropped_messages; }

}  // namespace fleetmap::bus
