#include "fleetmap/bus/local_network.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "event_queue.hpp"
#include "fleetmap/core/thread_pool.hpp"
#include "local_robot.hpp"
#include "radio.hpp"

namespace fleetmap::bus {
namespace {

double distance(const EnuPosition& a, const EnuPosition& b) {
  return std::hypot(a.east - b.east, a.north - b.north, a.up - b.up);
}

}  // namespace

struct LocalNetwork::State {
  explicit State(const LocalNetworkConfig& network_config)
      : config(network_config),
        events(config.start),
        pool(config.threads),
        long_range(Link::kLongRange, config.long_range, config.seed, events),
        // A stream of its own, so that traffic on one radio does not change the losses of the other.
        short_range(Link::kShortRange, config.short_range, config.seed ^ 0x9e3779b97f4a7c15u, events) {
    for (Radio* radio : {&long_range, &short_range}) {
      const Link link = radio == &long_range ? Link::kLongRange : Link::kShortRange;
      radio->connect(
          [this, link](const AgentId& from, const AgentId& to) { return reachable(link, from, to); },
          [this](const Transmission& arrived) { deliver(arrived); },
          [this](const Transmission& dropped) { count_drop(dropped); });
    }
  }

  Radio& radio(Link link) { return link == Link::kLongRange ? long_range : short_range; }

  bool blacked_out(Link link, const AgentId& agent) const {
    return std::any_of(blackouts.begin(), blackouts.end(), [&](const Blackout& blackout) {
      return blackout.link == link && (!blackout.agent || *blackout.agent == agent) &&
             blackout.from <= events.now() && events.now() < blackout.until;
    });
  }

  bool reachable(Link link, const AgentId& from, const AgentId& to) {
    if (blacked_out(link, from) || blacked_out(link, to)) return false;
    const double max_range = radio(link).config().max_range;
    if (max_range == 0.0) return true;
    const auto a = positions.find(from);
    const auto b = positions.find(to);
    return a != positions.end() && b != positions.end() && distance(a->second, b->second) <= max_range;
  }

  void transmit(const AgentId& from, const Topic& topic, const std::shared_ptr<const Bytes>& cdr) {
    for (const auto& [to, robot] : robots) {
      if (to == from || !robot->subscribes(topic) || !reachable(topic.link, from, to)) continue;
      radio(topic.link).send(Transmission{from, to, topic, cdr, events.now()});
    }
  }

  void deliver(const Transmission& arrived) {
    const auto robot = robots.find(arrived.to);
    if (robot != robots.end()) robot->second->deliver(arrived.from, arrived.topic, arrived.cdr);
  }

  void count_drop(const Transmission& dropped) {
    const auto robot = robots.find(dropped.from);
    if (robot != robots.end()) robot->second->count_drop(dropped.topic);
  }

  LocalNetworkConfig config;
  EventQueue events;
  ThreadPool pool;
  Radio long_range;
  Radio short_range;
  std::map<AgentId, EnuPosition> positions;
  std::vector<Blackout> blackouts;
  std::map<AgentId, std::unique_ptr<LocalRobot>> robots;
};

Result<std::unique_ptr<LocalNetwork>> LocalNetwork::create(const LocalNetworkConfig& config) {
  if (auto status = config.validate(); !status) return tl::unexpected(status.error());
  return std::unique_ptr<LocalNetwork>(new LocalNetwork(std::make_unique<State>(config)));
}

LocalNetwork::LocalNetwork(std::unique_ptr<State> state) : state_(std::move(state)) {}
LocalNetwork::~LocalNetwork() = default;

Bus& LocalNetwork::add_robot(const AgentId& agent) {
  auto [entry, fresh] = state_->robots.try_emplace(agent);
  if (!fresh) throw std::logic_error("two robots are called " + agent.str());
  entry->second = std::make_unique<LocalRobot>(
      state_->events, state_->pool, state_->config,
      [state = state_.get(), agent](const Topic& topic, std::shared_ptr<const Bytes> cdr) {
        state->transmit(agent, topic, cdr);
      });
  return *entry->second;
}

void LocalNetwork::remove_robot(const AgentId& agent) {
  state_->long_range.forget(agent);
  state_->short_range.forget(agent);
  state_->robots.erase(agent);
}

void LocalNetwork::finish_work(const AgentId& agent) {
  const auto robot = state_->robots.find(agent);
  if (robot != state_->robots.end()) robot->second->finish_work();
}

void LocalNetwork::set_position(const AgentId& agent, const EnuPosition& position) {
  state_->positions[agent] = position;
}

void LocalNetwork::add_blackout(const Blackout& blackout) { state_->blackouts.push_back(blackout); }

Stamp LocalNetwork::now() const { return state_->events.now(); }
void LocalNetwork::at(Stamp stamp, std::function<void()> event) {
  state_->events.at(stamp, std::move(event));
}
bool LocalNetwork::step() { return state_->events.step(); }
void LocalNetwork::run_until(Stamp stamp) { state_->events.run_until(stamp); }

std::vector<HeardCopies> LocalNetwork::take_heard(const AgentId& agent) {
  std::vector<HeardCopies> heard = state_->long_range.take_heard(agent);
  const std::vector<HeardCopies> near = state_->short_range.take_heard(agent);
  heard.insert(heard.end(), near.begin(), near.end());
  return heard;
}

std::vector<LinkUse> LocalNetwork::link_use() const {
  auto all = state_->long_range.use();
  const auto more = state_->short_range.use();
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace fleetmap::bus
