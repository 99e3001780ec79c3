#include "local_robot.hpp"

#include <stdexcept>
#include <utility>

namespace fleetmap::bus {

LocalRobot::LocalRobot(EventQueue& events, ThreadPool& pool, const LocalNetworkConfig& config,
                       Transmit transmit)
    : events_(events),
      pool_(pool),
      onboard_queue_capacity_(config.onboard_queue_capacity),
      transmit_(std::move(transmit)) {
  state_->lanes[static_cast<std::size_t>(Lane::kPerception)].time = config.perception_time;
  state_->lanes[static_cast<std::size_t>(Lane::kBackground)].time = config.background_time;
}

LocalRobot::~LocalRobot() { finish_work(); }

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

void LocalRobot::deliver(const AgentId& from, const Topic& topic, const std::shared_ptr<const Bytes>& cdr) {
  const auto alive = state_;  // a callback may switch this robot off
  const auto entry = alive->topics.find({topic.link, topic.name});
  if (entry == alive->topics.end()) return;
  alive->sender = from;
  run_subscribers(entry->second, *cdr);
  alive->sender.reset();
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

Handle LocalRobot::every(Duration period, Work callback) {
  if (period <= Duration::zero()) throw std::logic_error("a timer's period must be > 0");
  auto timer = std::make_shared<Timer>(Timer{period, std::move(callback.run)});
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

bool LocalRobot::offload(Lane lane, Work work, std::function<void()> done) {
  const auto index = static_cast<std::size_t>(lane);
  LaneState& state = state_->lanes[index];
  if (state.waiting.size() >= kMaxWork) return false;
  state.waiting.push_back({std::move(work.run), std::move(done)});
  if (state.busy) return true;
  state.busy = true;
  events_.post(
      [&events = events_, &pool = pool_, owner = std::weak_ptr<State>(state_), index, round = state.round] {
        const auto alive = owner.lock();
        if (alive && alive->lanes[index].round == round) start_next(events, pool, alive, index);
      });
  return true;
}

void LocalRobot::start_next(EventQueue& events, ThreadPool& pool, const std::shared_ptr<State>& state,
                            std::size_t lane) {
  LaneState& self = state->lanes[lane];
  self.busy = !self.waiting.empty();
  if (!self.busy) return;
  WorkItem item = std::move(self.waiting.front());
  self.waiting.pop_front();
  self.under_way = pool.run(std::move(item.work));
  events.at(events.now() + self.time, [&events, &pool, owner = std::weak_ptr<State>(state), lane,
                                       round = self.round, done = std::move(item.done)] {
    const auto alive = owner.lock();
    if (!alive || alive->lanes[lane].round != round) return;
    alive->lanes[lane].under_way.get();
    start_next(events, pool, alive, lane);
    done();
  });
}

void LocalRobot::finish_work() {
  for (LaneState& lane : state_->lanes) {
    lane.waiting.clear();
    if (lane.under_way.valid()) lane.under_way.wait();
    lane.under_way = {};
    lane.busy = false;
    ++lane.round;
  }
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
