#include "exchange/sim_fleet.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <variant>

#include "fleetmap/wire/messages.hpp"

namespace fleetmap::testing {

std::size_t payload_size(const Message& message) { return wire::encode(message).size(); }

SimFleet::SimFleet(const std::vector<std::string>& names, const Network& network, std::uint32_t seed,
                   const std::function<void(exchange::ExchangeConfig&)>& adjust)
    : network_(network), random_(seed) {
  for (const auto& name : names) config_.fleet.push_back(agent(name));
  config_.payload_size = payload_size;
  if (adjust) adjust(config_);
}

void SimFleet::share_radio(std::span<const std::string> names) {
  config_.on_radio.clear();
  for (const std::string& name : names) config_.on_radio.push_back(agent(name));
}

void SimFleet::start(const std::string& name, std::uint16_t session) {
  Robot& robot = robots_[agent(name)];
  // Virtual time knows no power cuts, and a real disk sync for every node would take most of the test's
  // time.
  store::StoreConfig no_sync;
  no_sync.sync_own_items = false;
  auto opened = store::Store::open(folder_ / (name + ".db"), agent(name), no_sync);
  if (!opened) throw std::runtime_error(opened.error().message);
  robot.store = std::make_unique<store::Store>(std::move(*opened));
  auto made = exchange::Exchange::make(config_, *robot.store, now_);
  if (!made) throw std::runtime_error(made.error().message);
  robot.exchange = std::make_unique<exchange::Exchange>(std::move(*made));
  robot.session = session;
  robot.exchange->begin_session(session);
}

void SimFleet::keep_store(const std::string& name) {
  std::filesystem::copy_file(folder_ / (name + ".db"), folder_ / (name + ".kept"),
                             std::filesystem::copy_options::overwrite_existing);
}

void SimFleet::put_back_store(const std::string& name) {
  lose_store(name);
  std::filesystem::copy_file(folder_ / (name + ".kept"), folder_ / (name + ".db"));
}

void SimFleet::lose_store(const std::string& name) {
  for (const char* end : {".db", ".db-wal", ".db-shm"}) std::filesystem::remove(folder_ / (name + end));
}

graph::Node SimFleet::add_node(const std::string& name, double east_m, std::size_t submap_bytes) {
  Robot& r = robot(name);
  const std::uint32_t seq = r.store->next_node_seq(r.session);
  const Bytes submap = random_bytes(submap_bytes, seq + 7919 * static_cast<std::uint32_t>(name.back()));
  auto node = make_node(agent(name), seq, submap, east_m, static_cast<std::uint32_t>(name.back()));
  node.G->covariance = Matrix6d::Identity();
  node.session = r.session;
  node.descriptor = random_bytes(graph::Node::kMaxDescriptorBytes, seq);
  const auto put = r.exchange->on_own_node(node, submap, now_);
  if (!put || *put != store::Put::kAdded) throw std::runtime_error("own node refused");
  return node;
}

void SimFleet::add_alignment(const std::string& name, const exchange::NodePair& pair, double rmse) {
  Robot& r = robot(name);
  const auto alignment =
      make_alignment(pair.ours, pair.theirs, agent(name), r.store->next_alignment_seq(r.session), rmse);
  const auto put = r.exchange->on_own_alignment(alignment, now_);
  if (!put || *put != store::Put::kAdded) throw std::runtime_error("own alignment refused");
}

void SimFleet::run_for(Duration time, const std::function<bool()>& until) {
  const Stamp end = now_ + time;
  while (now_ < end && !(until && until())) step();
}

void SimFleet::step() {
  now_ += std::chrono::milliseconds(20);
  while (!in_flight_.empty() && in_flight_.top().at <= now_) {
    const Flight flight = in_flight_.top();
    in_flight_.pop();
    const auto robot = robots_.find(flight.to);
    if (robot != robots_.end()) robot->second.exchange->on_message(*flight.message, flight.reach, now_);
  }
  for (auto& [name, robot] : robots_) {
    for (auto& outgoing : robot.exchange->tick(now_)) send(name, outgoing, robot);
    for (auto& event : robot.exchange->take_events()) react(name, robot, event);
  }
}

bool SimFleet::all(const std::function<bool(const Robot&)>& holds) const {
  return std::ranges::all_of(robots_, [&](const auto& entry) { return holds(entry.second); });
}

bool SimFleet::equal_sets(std::size_t nodes) const {
  const auto& first = *robots_.begin()->second.store;
  return all([&](const Robot& robot) {
    return robot.store->nodes().size() == nodes && robot.store->node_set() == first.node_set() &&
           robot.store->alignment_set() == first.alignment_set();
  });
}

void SimFleet::send(const AgentId& from, const exchange::Outgoing& outgoing, const Robot& robot) {
  const bool long_range = outgoing.reach == exchange::Reach::kLongRange;
  const std::size_t bytes = long_range ? robot.exchange->queue().wire_bytes(outgoing.message, outgoing.to)
                                       : payload_size(outgoing.message);
  sent_.push_back({now_, from, outgoing, bytes});
  const auto message = std::make_shared<const Message>(outgoing.message);
  for (const auto& [to, receiver] : robots_) {
    if (to == from || (outgoing.to && *outgoing.to != to) || !reachable(from, to, outgoing.reach)) continue;
    const double chance = std::uniform_real_distribution<double>(0.0, 1.0)(random_);
    if (chance < network_.loss) continue;
    const int copies = chance > 1.0 - network_.duplication ? 2 : 1;
    for (int copy = 0; copy < copies; ++copy) {
      const auto delay = std::uniform_int_distribution<std::int64_t>(network_.min_delay.count(),
                                                                     network_.max_delay.count())(random_);
      in_flight_.push({now_ + Duration(delay), order_++, to, outgoing.reach, message});
    }
  }
}

void SimFleet::react(const AgentId& name, Robot& robot, const exchange::Event& event) {
  robot.events.push_back(event);
  if (const auto* needed = std::get_if<exchange::CloudNeeded>(&event)) {
    auto& cloud = robot.clouds[needed->node];
    if (cloud.empty()) cloud = random_bytes(cloud_bytes, needed->node.seq + 31);
    if (!robot.exchange->provide_cloud(needed->node, cloud, now_)) throw std::runtime_error("cloud refused");
  } else if (const auto* arrived = std::get_if<exchange::CloudArrived>(&event)) {
    robot.arrived.push_back(*arrived);
    if (!register_clouds) return;
    const auto rmse = registration(arrived->pair);
    if (rmse) {
      add_alignment(name.str(), arrived->pair, *rmse);
    } else {
      robot.exchange->on_rejected(arrived->pair, now_);
    }
  }
}

}  // namespace fleetmap::testing
