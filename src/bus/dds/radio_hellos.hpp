#pragma once

#include <chrono>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "radio_link.hpp"

namespace fleetmap::bus {

/// Sends and receives the Hellos by which robots find each other on a radio, and keeps the link's peers by
/// them. All calls are made with the link's mutex held, except tick(), which takes it.
class RadioLink::Hellos {
 public:
  explicit Hellos(RadioLink& radio) : radio_(radio) {}

  /// Processes received Hellos, drops silent peers and sends the Hellos that are due; every kTick.
  void tick();
  void send_hello(RemoteLocator& remote, bool leaves = false);
  /// The topics that this robot reads have changed, so its peers need another Hello.
  void reads_changed();
  /// Processes a Hello whose sender needs no proof or has given it.
  void on_hello(const Prefix& sender, const Hello& hello, const Acquaintance& acquaintance);
  void on_other_version(const Bytes& cdr);
  static Introductions::Prefix bytes_of(const Prefix& prefix);
  void refuse(const Locator& from, const std::string& why);

 private:
  void count_answer(const Hello& hello, const Acquaintance& acquaintance);
  void admit_successors();
  Clock::duration first_pause() const;
  std::int64_t sought() const;
  bool joined_before(Clock::time_point joined) const;
  void warn_of_silent_remotes(Clock::time_point now);
  void send_due_hellos(Clock::time_point now);
  std::vector<Prefix> silent() const;
  void warn_of_namesake(const Prefix& sender, const Hello& hello, const Locator& from);
  RemoteLocator* claim_remote(const Prefix& sender, const Hello& hello, const Acquaintance& acquaintance,
                              const Locator& from, bool& replaced);
  void meet(const Prefix& sender, const Hello& hello, const Acquaintance& acquaintance, RemoteLocator& remote,
            bool replaced);
  void note(const AgentId& agent, const std::optional<FleetSettings>& settings, bool multicast,
            const Locator& from);
  void connect(const Prefix& robot, const Peer& peer);
  bool introduces() const;
  int rank(const RemoteLocator& remote) const;
  std::set<EntityKey> reads_of(const AgentId& robot) const;
  bool shares_settings(const Hello& hello) const;
  std::vector<Introduction> introductions_to(const RemoteLocator& remote) const;
  void on_introductions(const Prefix& sender, const Hello& hello);
  bool introduce(const Introduction& introduction, const AgentId& by);
  void seek_sooner();
  void hear_introduced();

  RadioLink& radio_;
  std::mt19937 random_{std::random_device{}()};
  Clock::time_point hello_free_{};  ///< no other Hello before
  int sought_in_a_row_ = 0;         ///< Hellos to robots that are sought, since the last to one that is known
  std::set<Prefix> namesakes_;      ///< reported in the log
};

}  // namespace fleetmap::bus
