#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/bus/bus.hpp"
#include "fleetmap/bus/local_network_config.hpp"
#include "fleetmap/bus/radio_config.hpp"
#include "fleetmap/bus/wire_overhead.hpp"
#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::bus {

/// Metres in the ENU frame of the site.
struct EnuPosition {
  double east = 0.0;
  double north = 0.0;
  double up = 0.0;
};

/// A time in which a radio passes nothing, for one robot or (without `agent`) for all. Messages whose
/// transmission ends in [from, until) are lost.
struct Blackout {
  Link link = Link::kShortRange;
  Stamp from{};
  Stamp until{};
  std::optional<AgentId> agent;
};

/// The cost of one topic of one robot on one radio.
struct LinkUse {
  AgentId agent;
  Link link = Link::kLongRange;
  std::string topic;
  std::uint64_t copies = 0;      ///< transmissions begun, one per receiving robot
  std::uint64_t wire_bytes = 0;  ///< payload and overhead, with what was sent again
  Duration airtime{};
  std::uint64_t lost = 0;     ///< copies that did not arrive: loss, range, blackout
  std::uint64_t dropped = 0;  ///< copies that a full transmit queue let go
};

/// Copies of messages that one robot had from another over a radio.
struct HeardCopies {
  Link link = Link::kLongRange;
  AgentId from;
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;  ///< on the wire, without what was sent again
  std::uint64_t lost = 0;   ///< loss, range, blackout
  Duration delay{};         ///< sum over the messages, from their publication on
};

/// A fleet in one process in virtual time: an event queue, and a Bus per robot over simulated links. The same
/// calls with the same seed give the same run, on any machine and with any number of threads. Not
/// thread-safe; events at one instant run in the order in which they were scheduled.
///
/// Onboard messages arrive at the instant they are published. On a radio a message goes once to each robot
/// that subscribes to its topic and is in reach; robots with waiting messages take turns. A robot without a
/// position is out of reach of every radio that has a max_range.
class LocalNetwork {
 public:
  static Result<std::unique_ptr<LocalNetwork>> create(const LocalNetworkConfig& config);
  ~LocalNetwork();
  LocalNetwork(const LocalNetwork&) = delete;
  LocalNetwork& operator=(const LocalNetwork&) = delete;

  /// The Bus stays where it is until `remove_robot` or the network's end. A name that is taken is a bug:
  /// throws std::logic_error.
  Bus& add_robot(const AgentId& agent);
  /// Switches a robot off: its timers, subscriptions, work and waiting messages go with it.
  void remove_robot(const AgentId& agent);
  /// Waits for the robot's offloaded work under way and lets go of what waits; nothing follows from either.
  void finish_work(const AgentId& agent);

  void set_position(const AgentId& agent, const EnuPosition& position);
  void add_blackout(const Blackout& blackout);

  Stamp now() const;
  /// Runs `event` at `stamp`, or now if that is past.
  void at(Stamp stamp, std::function<void()> event);
  /// Runs the next event; false if there is none.
  bool step();
  /// Runs every event up to and including `stamp`; then it is `stamp`.
  void run_until(Stamp stamp);

  std::vector<LinkUse> link_use() const;
  /// By sender and radio, since the last call for this robot (or since the start).
  std::vector<HeardCopies> take_heard(const AgentId& agent);

 private:
  struct State;
  explicit LocalNetwork(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace fleetmap::bus
