#include "live_publisher.hpp"

#include <algorithm>
#include <iterator>

#include "fleet_state.hpp"
#include "fleetmap/agent/navigator.hpp"
#include "report/candidate_report.hpp"
#include "sensor_findings.hpp"

namespace fleetmap::apps {
namespace {

constexpr std::array<const char*, exchange::kPriorities> kPriorityNames{"safety", "control",  "news",
                                                                        "state",  "backfill", "cloud"};

/// Passes an order on. Stamp zero: it replaces all others.
void give(agent::Agent& agent, const AgentId& issuer, const monitor::OrderRequest& request) {
  using Request = monitor::OrderRequest::Kind;
  using Kind = messages::HoldOrder::Kind;
  const AgentId robot = request.robot.value_or(AgentId{});
  if (request.kind == Request::kGive)
    return agent.give_order(
        messages::RowOrder{{}, robot, request.to.value_or(AgentId{}), issuer, request.row});
  const Kind kind = request.kind == Request::kHold   ? Kind::kHold
                    : request.kind == Request::kHome ? Kind::kHome
                                                     : Kind::kResume;
  agent.give_order(messages::HoldOrder{{}, robot, issuer, kind});
}

void add_missing_submaps(const store::Store& store, double rate, monitor::RadioNow& radio) {
  const std::vector<SeqRange> missing = store.node_set().minus(store.submap_set());
  if (missing.empty()) {
    radio.seconds_to_equal_map = 0.0;
    return;
  }
  for (const SeqRange& range : missing) {
    for (const graph::Node* node : store.nodes_from(range)) {
      ++radio.missing_submaps;
      radio.missing_bytes += node->submap_bytes;
    }
  }
  if (rate > 0.0) radio.seconds_to_equal_map = static_cast<double>(radio.missing_bytes) / rate;
}

}  // namespace

LivePublisher::LivePublisher(agent::Agent& agent, bus::Bus& bus, monitor::Server& server,
                             std::string who_may_join, const Post& post)
    : agent_(agent), bus_(bus), server_(server), who_may_join_(std::move(who_may_join)) {
  const AgentId self = agent.config().id;
  const std::vector<AgentId> fleet = agent.config().exchange.fleet;
  server_.set_operator([&agent, post, self, fleet](const monitor::OrderRequest& request) -> Status {
    for (const auto& robot : {request.robot, request.to}) {
      if (robot && std::ranges::find(fleet, *robot) == fleet.end())
        return failure(robot->str() + " is no robot of this fleet");
    }
    if (!post([&agent, self, request] { give(agent, self, request); }))
      return failure("the robot is too busy; try again");
    return {};
  });
}

LivePublisher::~LivePublisher() { server_.set_operator({}); }

void LivePublisher::publish(const std::vector<bus::HeardTraffic>& heard, const LastHeard& last_heard,
                            const std::vector<const agent::Agent*>& others) {
  monitor::LiveStatus status;
  status.self = agent_.config().id;
  status.lost_after_s = lost_after(agent_);
  FleetState fleet = fleet_state(agent_, last_heard, bus_.now());
  status.candidates = candidates_of(agent_);
  for (const agent::Agent* other : others) {
    fleet.problems[other->config().id] = problems_of(*other, bus_.now());
    fleet.totals[other->config().id] = totals_of(*other);
    std::ranges::move(candidates_of(*other), std::back_inserter(status.candidates));
  }
  status.robots = robot_states(fleet);
  for (monitor::RobotNow& robot : status.robots) {
    add_silence(status.lost_after_s, robot);
    problems_.update(robot, bus_.now());
  }
  status.maps = progress_.add(status.robots, status.self, status.lost_after_s, bus_.now());
  status.sensors = sensors_.add(agent_.perception(), bus_.now());
  add_findings(status.sensors);
  status.radio = radio(heard);
  server_.publish(std::make_shared<const monitor::LiveStatus>(std::move(status)));
}

void LivePublisher::add_findings(std::vector<monitor::SensorNow>& sensors) const {
  for (SensorFinding& one : sensor_findings(agent_.perception(), bus_.now())) {
    if (!one.source) continue;
    const auto sensor = std::ranges::find(sensors, to_string(*one.source), &monitor::SensorNow::name);
    if (sensor != sensors.end()) sensor->findings.push_back({std::move(one.text), one.is_over});
  }
}

monitor::RadioNow LivePublisher::radio(const std::vector<bus::HeardTraffic>& heard) {
  const exchange::ExchangeStats stats = agent_.exchange_stats();
  const exchange::SendQueue& queue = agent_.exchange().queue();
  const RadioCounters counters{agent_.bus_stats(),
                               stats.long_range.wire_bytes + bus_.discovery_bytes(bus::Link::kLongRange),
                               agent_.config().exchange.long_range.overhead_bytes};
  monitor::RadioNow radio = rates_.add(counters, heard, bus_.now());
  radio.who_may_join = who_may_join_;
  radio.share = queue.share_bytes_per_second();
  radio.fleet_budget = agent_.config().exchange.long_range.fleet_bytes_per_second;
  radio.backlog_bytes = queue.backlog_bytes();
  if (radio.share > 0.0) radio.backlog_s = static_cast<double>(radio.backlog_bytes) / radio.share;
  for (std::size_t k = 0; k < exchange::kPriorities; ++k) {
    radio.queues.push_back(
        {kPriorityNames[k], queue.size(static_cast<exchange::Priority>(k)), stats.long_range.dropped[k]});
  }
  add_missing_submaps(agent_.store(), rates_.submap_rate(), radio);
  return radio;
}

}  // namespace fleetmap::apps
