#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <queue>
#include <string>
#include <tuple>
#include <vector>

#include "fleetmap/exchange/exchange.hpp"
#include "fleetmap/loop_closure/candidate_scheduler.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::fault_injection {

/// A packet that a robot sent at `at`.
struct Packet {
  Stamp at;
  AgentId from;
  messages::Outgoing outgoing;
  std::size_t wire_bytes = 0;  ///< on the radio with overhead and copies, on the short range the payload
};

/// Stores and exchanges of a fleet on a network in virtual time. The derived class decides which packets the
/// network delivers and how a robot reacts to an event.
class ExchangeFleet {
 public:
  struct Robot {
    std::unique_ptr<store::Store> store;
    std::unique_ptr<loop_closure::CandidateScheduler> cloud_client;
    std::unique_ptr<exchange::Exchange> exchange;
    std::uint16_t session = 0;
    Duration clock_offset = Duration::zero();  ///< of the robot's clock from virtual time
    std::vector<exchange::Event> events;       ///< since the robot started, or since they were cleared
    std::vector<loop_closure::ReceivedCloud> received;  ///< likewise
    std::map<NodeId, Bytes> clouds;                     ///< made for peers
  };

  /// `folder` holds the stores. `tick` is the time between two ticks of every exchange.
  ExchangeFleet(std::filesystem::path folder, const exchange::ExchangeConfig& config, Duration tick)
      : config_(config), folder_(std::move(folder)), tick_(tick) {}
  virtual ~ExchangeFleet() = default;
  ExchangeFleet(const ExchangeFleet&) = delete;
  ExchangeFleet& operator=(const ExchangeFleet&) = delete;

  Robot& robot(const AgentId& name) { return robots_.at(name); }
  bool runs(const AgentId& name) const { return robots_.contains(name); }
  const std::map<AgentId, Robot>& robots() const { return robots_; }
  Stamp now() const { return now_; }
  const exchange::ExchangeConfig& config() const { return config_; }

  void run_for(Duration time, const std::function<bool()>& until = {});
  void step();

 protected:
  using DrawSession = std::function<Result<std::uint16_t>(store::Store&)>;

  Result<store::Store> open_store(const AgentId& name, const store::StoreConfig& config) const {
    return store::Store::open(file(name, ".db"), name, config);
  }
  /// Opens the file that the robot left, or makes it, and begins a session.
  Status start(const AgentId& name, const store::StoreConfig& store, Duration clock_offset,
               const DrawSession& draw_session);
  /// As kill -9 does: memory is gone, files stay as they are at this moment.
  void kill(const AgentId& name);
  /// A derived class that owns the disks of the stores calls this before these go: to close a store writes.
  void close_stores() { robots_.clear(); }
  /// The robot's files as they are now go to a copy, and back to what the copy holds (none: no store). Those
  /// of a robot that runs may only be copied.
  void keep_store(const AgentId& name, const std::string& copy) const;
  void put_back_store(const AgentId& name, const std::string& copy) const;
  void lose_store(const AgentId& name) const;
  /// Overwrites a page at this share of its database.
  void damage_store(const AgentId& name, double at) const;

  /// Delivers after `delay`, from `from` if the link can name the sender.
  void deliver(const AgentId& to, messages::Reach reach, std::shared_ptr<const messages::Message> message,
               Duration delay, std::optional<AgentId> from = std::nullopt);

  virtual void on_sent(const Packet& packet) = 0;
  /// The message as it goes on the air; null: it is not sent.
  virtual std::shared_ptr<const messages::Message> on_air(const Packet& packet);
  /// After which delays copies of `packet` arrive at `to`; none: it is lost.
  virtual std::vector<Duration> arrivals(const Packet& packet, const AgentId& to) = 0;
  virtual void on_event(const AgentId& name, Robot& robot, const exchange::Event& event) = 0;
  virtual void on_received(const AgentId& name, Robot& robot,
                           const loop_closure::ReceivedCloud& received) = 0;
  /// Passes on the events of the robot's exchange and loop closing.
  void pass_on(const AgentId& name, Robot& robot);

  exchange::ExchangeConfig config_;            ///< of the robots that start from now on
  loop_closure::CandidateConfig loop_config_;  ///< likewise

 private:
  struct Flight {
    Stamp at;
    std::uint64_t order;
    AgentId to;
    messages::Reach reach;
    std::shared_ptr<const messages::Message> message;
    std::optional<AgentId> from;
    bool operator>(const Flight& other) const {
      return std::tie(at, order) > std::tie(other.at, other.order);
    }
  };
  std::filesystem::path file(const AgentId& name, const std::string& end) const {
    return folder_ / (name.str() + end);
  }
  void send(const AgentId& from, const messages::Outgoing& outgoing, const Robot& robot);

  std::filesystem::path folder_;
  Duration tick_;
  Stamp now_ = stamp_from_ns(1'700'000'000'000'000'000);
  std::map<AgentId, Robot> robots_;
  std::priority_queue<Flight, std::vector<Flight>, std::greater<>> in_flight_;
  std::uint64_t order_ = 0;
};

}  // namespace fleetmap::fault_injection
