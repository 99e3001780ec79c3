#include "fleetmap/fault_injection/exchange_fleet.hpp"

#include <fstream>
#include <string>
#include <utility>

#include "fleetmap/core/paths.hpp"

namespace fleetmap::fault_injection {
namespace {

constexpr const char* kDatabase = ".db";
constexpr const char* kLog = ".db-wal";

/// Empty for a missing file.
void copy_if_there(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::filesystem::remove(to);
  if (is_there(from)) std::filesystem::copy_file(from, to);
}

}  // namespace

void ExchangeFleet::run_for(Duration time, const std::function<bool()>& until) {
  const Stamp end = now_ + time;
  while (now_ < end && !(until && until())) step();
}

void ExchangeFleet::step() {
  now_ += tick_;
  while (!in_flight_.empty() && in_flight_.top().at <= now_) {
    const Flight flight = in_flight_.top();
    in_flight_.pop();
    const auto robot = robots_.find(flight.to);
    if (robot == robots_.end()) continue;
    robot->second.exchange->on_message(*flight.message, flight.reach, now_ + robot->second.clock_offset,
                                       flight.from);
  }
  for (auto& [name, robot] : robots_) {
    for (auto& outgoing : robot.exchange->tick(now_ + robot.clock_offset)) send(name, outgoing, robot);
    pass_on(name, robot);
  }
}

void ExchangeFleet::pass_on(const AgentId& name, Robot& robot) {
  for (auto& event : robot.exchange->take_events()) {
    robot.events.push_back(event);
    on_event(name, robot, event);
  }
  for (auto& received : robot.cloud_client->take_received()) {
    robot.received.push_back(received);
    on_received(name, robot, received);
  }
}

Status ExchangeFleet::start(const AgentId& name, const store::StoreConfig& store, Duration clock_offset,
                            const DrawSession& draw_session) {
  Robot robot;
  robot.clock_offset = clock_offset;
  auto opened = open_store(name, store);
  if (!opened) return tl::unexpected(opened.error());
  robot.store = std::make_unique<store::Store>(std::move(*opened));
  const auto session = draw_session(*robot.store);
  if (!session) return tl::unexpected(session.error());
  loop_closure::CandidateConfig loops = loop_config_;
  loops.peer_timeout = exchange::for_fleet(loops.peer_timeout, config_);
  robot.cloud_client = std::make_unique<loop_closure::CandidateScheduler>(name, loops);
  auto made = exchange::Exchange::make(config_, *robot.store, *robot.cloud_client, now_ + clock_offset);
  if (!made) return tl::unexpected(made.error());
  robot.exchange = std::make_unique<exchange::Exchange>(std::move(*made));
  robot.session = *session;
  robot.exchange->begin_session(*session);
  robots_.insert_or_assign(name, std::move(robot));
  return {};
}

void ExchangeFleet::kill(const AgentId& name) {
  // To close the database would write its log back, which a process that is killed does not do.
  keep_store(name, ".killed");
  robots_.erase(name);
  put_back_store(name, ".killed");
}

void ExchangeFleet::keep_store(const AgentId& name, const std::string& copy) const {
  for (const char* end : {kDatabase, kLog}) copy_if_there(file(name, end), file(name, copy + end));
}

void ExchangeFleet::put_back_store(const AgentId& name, const std::string& copy) const {
  lose_store(name);
  for (const char* end : {kDatabase, kLog}) copy_if_there(file(name, copy + end), file(name, end));
}

void ExchangeFleet::lose_store(const AgentId& name) const {
  for (const char* end : {kDatabase, kLog, ".db-shm"}) std::filesystem::remove(file(name, end));
}

void ExchangeFleet::damage_store(const AgentId& name, double at) const {
  constexpr std::size_t kPageBytes = 4096;
  const std::filesystem::path path = file(name, kDatabase);
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error || size < kPageBytes) return;
  std::fstream out(path, std::ios::binary | std::ios::in | std::ios::out);
  out.seekp(static_cast<std::streamoff>(at * static_cast<double>(size / kPageBytes)) * kPageBytes);
  const std::string garbage(kPageBytes, '\x5a');
  out.write(garbage.data(), static_cast<std::streamsize>(garbage.size()));
}

void ExchangeFleet::deliver(const AgentId& to, messages::Reach reach,
                            std::shared_ptr<const messages::Message> message, Duration delay,
                            std::optional<AgentId> from) {
  in_flight_.push({now_ + delay, order_++, to, reach, std::move(message), std::move(from)});
}

std::shared_ptr<const messages::Message> ExchangeFleet::on_air(const Packet& packet) {
  return std::make_shared<const messages::Message>(packet.outgoing.message);
}

void ExchangeFleet::send(const AgentId& from, const messages::Outgoing& outgoing, const Robot& robot) {
  const bool long_range = outgoing.reach == messages::Reach::kLongRange;
  const std::size_t bytes = long_range ? robot.exchange->queue().wire_bytes(outgoing.message, outgoing.to)
                                       : config_.payload_size(outgoing.message);
  const Packet packet{now_, from, outgoing, bytes};
  on_sent(packet);
  const auto message = on_air(packet);
  if (!message) return;
  for (const auto& [to, receiver] : robots_) {
    if (to == from || (outgoing.to && *outgoing.to != to)) continue;
    for (const Duration delay : arrivals(packet, to)) deliver(to, outgoing.reach, message, delay, from);
  }
}

}  // namespace fleetmap::fault_injection
