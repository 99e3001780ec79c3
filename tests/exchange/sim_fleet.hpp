#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "fleetmap/fault_injection/exchange_fleet.hpp"
#include "store/items.hpp"

namespace fleetmap::testing {

using messages::Message;

/// Bytes of a message as agents publish it.
std::size_t payload_size(const Message& message);

/// Names of a fleet.
inline const std::vector<std::string> kThree{"r1", "r2", "r3"};

/// A fleet of exchanges on a network that loses, delays, reorders and doubles messages, in virtual time.
class SimFleet : private TemporaryFolder, public fault_injection::ExchangeFleet {
 public:
  struct Network {
    double loss = 0.0;
    double duplication = 0.0;
    Duration min_delay = std::chrono::milliseconds(5);
    Duration max_delay = std::chrono::milliseconds(60);
    /// A queue that all short-range IP packets pass; none: unlimited.
    struct Queue {
      double bytes_per_second;
      double bytes;  ///< B that it holds
    };
    std::optional<Queue> short_range = std::nullopt;
  };
  using Sent = fault_injection::Packet;

  SimFleet(const std::vector<std::string>& names, const Network& network, std::uint32_t seed,
           const std::function<void(exchange::ExchangeConfig&)>& adjust = {},
           const std::function<void(loop_closure::CandidateConfig&)>& adjust_loops = {});

  /// Makes these robots, started from now on, share one radio of their own.
  void share_radio(std::span<const std::string> names);
  /// Those that start from now on sign their items.
  void authenticate(std::shared_ptr<const exchange::ItemAuthenticator> authenticator) {
    config_.authenticator = std::move(authenticator);
  }
  /// Puts the store of a robot that starts from now on into this SQLite VFS, which is synced as on a robot.
  void put_on_disk(const std::string& name, std::string file_system) {
    disks_[agent(name)] = std::move(file_system);
  }
  /// Goes on with the file that the robot left, in session `session`.
  void start(const std::string& name, std::uint16_t session = 0);
  void kill(const std::string& name) { ExchangeFleet::kill(agent(name)); }
  /// Keeps the store file of a stopped robot as it is now, or restores it (none: removes it).
  void keep_store(const std::string& name) { ExchangeFleet::keep_store(agent(name), ".kept"); }
  void put_back_store(const std::string& name) { ExchangeFleet::put_back_store(agent(name), ".kept"); }
  void lose_store(const std::string& name) { ExchangeFleet::lose_store(agent(name)); }
  std::filesystem::path store_file(const std::string& name) const {
    return static_cast<const TemporaryFolder&>(*this) / (name + ".db");
  }
  Robot& robot(const std::string& name) { return ExchangeFleet::robot(agent(name)); }

  graph::Node add_node(const std::string& name, double east_m, std::size_t submap_bytes = 3000);
  /// `message` comes to `name` now, whoever sent it.
  void forge(const std::string& name, const Message& message, std::optional<AgentId> from = std::nullopt);
  void add_alignment(const std::string& name, const exchange::NodePair& pair, double rmse);

  /// `reachable(from, to, link)`: by default everyone hears everyone on the long-range link, nobody on the
  /// other.
  std::function<bool(const AgentId&, const AgentId&, messages::Reach)> reachable =
      [](const AgentId&, const AgentId&, messages::Reach reach) {
        return reach == messages::Reach::kLongRange;
      };
  /// RMSE of the registration of a pair, nothing when it is rejected.
  std::function<std::optional<double>(const exchange::NodePair&)> registration =
      [](const exchange::NodePair&) { return std::optional(0.2); };
  /// Messages that no robot receives.
  std::function<bool(const Sent&)> lost = [](const Sent&) { return false; };
  std::size_t cloud_bytes = 24'000;
  bool register_clouds = true;

  const std::vector<Sent>& sent() const { return sent_; }
  void forget_sent() { sent_.clear(); }
  /// B that passed the queue of the short range, and how many packets it dropped.
  double short_range_bytes() const { return short_range_bytes_; }
  std::size_t short_range_drops() const { return short_range_drops_; }
  bool all(const std::function<bool(const Robot&)>& holds) const;
  /// Every running robot holds the same nodes and alignments, and `nodes` of them.
  bool equal_sets(std::size_t nodes) const;
  /// Every robot holds the same contents under the same names.
  bool equal_contents() const;

 private:
  void on_sent(const fault_injection::Packet& packet) override;
  std::vector<Duration> arrivals(const fault_injection::Packet& packet, const AgentId& to) override;
  void on_event(const AgentId& name, Robot& robot, const exchange::Event& event) override;
  void on_received(const AgentId& name, Robot& robot, const loop_closure::ReceivedCloud& received) override;

  void name_anew(Robot& robot);
  /// Until the last packet of `packet` has left the queue; nothing if it dropped one.
  std::optional<Duration> queueing(const fault_injection::Packet& packet);

  Network network_;
  std::mt19937 random_;
  std::uint16_t last_session_ = 30'000;  ///< of those that are drawn while running
  std::vector<Sent> sent_;
  Stamp queue_empty_;               ///< when the queue of the short range will be
  std::optional<Duration> queued_;  ///< of the last packet
  double short_range_bytes_ = 0.0;
  std::size_t short_range_drops_ = 0;
  std::map<AgentId, std::string> disks_;
};

/// No loop candidates, hence no clouds.
void no_candidates(loop_closure::CandidateConfig& config);

/// The robots drive on parallel tracks 8 m apart and make `nodes` nodes each, one every 2 s and 4 m.
void drive(SimFleet& fleet, const std::vector<std::string>& names, int nodes, double start_m = 0.0);

/// Events of one kind of a robot.
template <class Kind>
std::vector<Kind> events(const SimFleet::Robot& robot) {
  std::vector<Kind> found;
  for (const exchange::Event& event : robot.events) {
    if (const auto* kind = std::get_if<Kind>(&event)) found.push_back(*kind);
  }
  return found;
}

}  // namespace fleetmap::testing
