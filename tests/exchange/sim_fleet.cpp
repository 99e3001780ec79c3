#include "exchange/sim_fleet.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <variant>

#include "fleetmap/exchange/reissue.hpp"
#include "fleetmap/fleet_codec/messages.hpp"

namespace fleetmap::testing {

std::size_t payload_size(const Message& message) { return fleet_codec::encode(message).size(); }

SimFleet::SimFleet(const std::vector<std::string>& names, const Network& network, std::uint32_t seed,
                   const std::function<void(exchange::ExchangeConfig&)>& adjust,
                   const std::function<void(loop_closure::CandidateConfig&)>& adjust_loops)
    : ExchangeFleet(static_cast<const TemporaryFolder&>(*this) / "", {}, std::chrono::milliseconds(20)),
      network_(network),
      random_(seed) {
  for (const auto& name : names) config_.fleet.push_back(agent(name));
  config_.payload_size = payload_size;
  if (adjust) adjust(config_);
  if (adjust_loops) adjust_loops(loop_config_);
  config_.clouds.cancel_when_aligned = loop_config_.stop_when_peer_aligned;
}

void SimFleet::share_radio(std::span<const std::string> names) {
  config_.on_radio.clear();
  for (const std::string& name : names) config_.on_radio.push_back(agent(name));
}

void SimFleet::start(const std::string& name, std::uint16_t session) {
  // Without such a disk virtual time knows no power cuts, and a real disk sync for every node would take most
  // of the test's time.
  store::StoreConfig config;
  const auto disk = disks_.find(agent(name));
  config.power_safe = disk != disks_.end();
  if (disk != disks_.end()) config.file_system = disk->second;
  const Status started =
      ExchangeFleet::start(agent(name), config, Duration::zero(), [&](store::Store&) { return session; });
  if (!started) throw std::runtime_error(started.error().message);
  name_anew(robot(name));
}

graph::Node SimFleet::add_node(const std::string& name, double east_m, std::size_t submap_bytes) {
  Robot& r = robot(name);
  const std::uint32_t seq = r.store->next_node_seq(r.session);
  const Bytes submap = random_bytes(submap_bytes, seq + 7919 * static_cast<std::uint32_t>(name.back()));
  auto node = make_node(agent(name), seq, submap, east_m, static_cast<std::uint32_t>(name.back()));
  node.G->covariance = Matrix6d::Identity();
  node.session = r.session;
  node.descriptor = random_bytes(graph::Node::kMaxDescriptorBytes, seq);
  const auto put = r.exchange->on_own_node(node, submap, now());
  if (!put || *put != store::Put::kAdded) throw std::runtime_error("own node refused");
  return node;
}

void SimFleet::forge(const std::string& name, const Message& message, std::optional<AgentId> from) {
  Robot& r = robot(name);
  r.exchange->on_message(message, messages::usual_reach(message), now(), std::move(from));
  pass_on(agent(name), r);
}

void SimFleet::name_anew(Robot& robot) {
  const exchange::NewNames names{robot.session, [this]() -> Result<std::uint16_t> { return ++last_session_; },
                                 [](const graph::Alignment& a) -> Result<graph::Alignment> { return a; }};
  const auto told = exchange::reissue_contested(*robot.exchange, *robot.store, names, now());
  if (!told) throw std::runtime_error(told.error().message);
}

void SimFleet::add_alignment(const std::string& name, const exchange::NodePair& pair, double rmse) {
  Robot& r = robot(name);
  const auto alignment =
      make_alignment(pair.ours, pair.theirs, agent(name), r.store->next_alignment_seq(r.session), rmse);
  const auto put = r.exchange->on_own_alignment(alignment, now());
  if (!put || *put != store::Put::kAdded) throw std::runtime_error("own alignment refused");
}

bool SimFleet::all(const std::function<bool(const Robot&)>& holds) const {
  return std::ranges::all_of(robots(), [&](const auto& entry) { return holds(entry.second); });
}

bool SimFleet::equal_sets(std::size_t nodes) const {
  const auto& first = *robots().begin()->second.store;
  return all([&](const Robot& robot) {
    return robot.store->nodes().size() == nodes && robot.store->node_set() == first.node_set() &&
           robot.store->alignment_set() == first.alignment_set();
  });
}

bool SimFleet::equal_contents() const {
  const auto& first = *robots().begin()->second.store;
  return all([&](const Robot& robot) {
    const auto same_print = [&](const AgentId& maker) {
      const SeqRange range{maker, 0, kEndOfSeqs};
      return robot.store->node_print(range) == first.node_print(range) &&
             robot.store->alignment_print(range) == first.alignment_print(range);
    };
    return equal_sets(first.nodes().size()) && std::ranges::all_of(config_.fleet, same_print);
  });
}

void SimFleet::on_sent(const fault_injection::Packet& packet) {
  sent_.push_back(packet);
  const bool queues = network_.short_range && packet.outgoing.reach == messages::Reach::kShortRange;
  queued_ = queues ? queueing(packet) : Duration::zero();
}

std::vector<Duration> SimFleet::arrivals(const fault_injection::Packet& packet, const AgentId& to) {
  std::vector<Duration> delays;
  if (!reachable(packet.from, to, packet.outgoing.reach)) return delays;
  const double chance = std::uniform_real_distribution<double>(0.0, 1.0)(random_);
  if (chance < network_.loss) return delays;
  if (!queued_ || lost(packet)) return delays;
  const int copies = chance > 1.0 - network_.duplication ? 2 : 1;
  for (int copy = 0; copy < copies; ++copy) {
    delays.emplace_back(queued_->count() +
                        std::uniform_int_distribution<std::int64_t>(network_.min_delay.count(),
                                                                    network_.max_delay.count())(random_));
  }
  return delays;
}

std::optional<Duration> SimFleet::queueing(const fault_injection::Packet& packet) {
  constexpr double kMtu = 1500.0,
                   kHeaders = 60.0;  // B; headers as submap_transfer.overhead_bytes counts them
  queue_empty_ = std::max(queue_empty_, now());
  bool whole = true;
  const auto payload = static_cast<double>(packet.wire_bytes);
  const auto packets = static_cast<int>(std::ceil(payload / (kMtu - kHeaders)));
  for (int k = 0; k < packets; ++k) {
    const double bytes = payload / packets + kHeaders;
    const double backlog = to_seconds(queue_empty_ - now()) * network_.short_range->bytes_per_second;
    if (backlog + bytes > network_.short_range->bytes) {
      ++short_range_drops_;
      whole = false;
      continue;
    }
    short_range_bytes_ += bytes;
    queue_empty_ += from_seconds(bytes / network_.short_range->bytes_per_second);
  }
  return whole ? std::optional(queue_empty_ - now()) : std::nullopt;
}

void SimFleet::on_event(const AgentId& name, Robot& robot, const exchange::Event& event) {
  if (std::holds_alternative<exchange::SessionTaken>(event)) {
    robot.session = ++last_session_;
    robot.exchange->begin_session(robot.session);
  }
  if (const auto* conflict = std::get_if<exchange::ItemConflict>(&event);
      conflict && conflict->id.agent == name)
    name_anew(robot);
  if (const auto* needed = std::get_if<exchange::CloudNeeded>(&event)) {
    auto& cloud = robot.clouds[needed->node];
    if (cloud.empty()) cloud = random_bytes(cloud_bytes, needed->node.seq + 31);
    if (!robot.exchange->provide_cloud(needed->node, cloud, now())) throw std::runtime_error("cloud refused");
  }
}

void SimFleet::on_received(const AgentId& name, Robot& robot, const loop_closure::ReceivedCloud& received) {
  if (!register_clouds) return;
  const exchange::NodePair pair = received.candidate.pair();
  if (const auto rmse = registration(pair)) {
    add_alignment(name.str(), pair, *rmse);
  } else {
    robot.cloud_client->on_rejected(pair, now());
  }
}

void no_candidates(loop_closure::CandidateConfig& config) { config.proximity.min_radius = 0.1; }

void drive(SimFleet& fleet, const std::vector<std::string>& names, int nodes, double start_m) {
  for (int k = 0; k < nodes; ++k) {
    double offset = 0.0;
    for (const auto& name : names) fleet.add_node(name, start_m + 4.0 * k + (offset += 1.0));
    fleet.run_for(std::chrono::seconds(2));
  }
}

}  // namespace fleetmap::testing
