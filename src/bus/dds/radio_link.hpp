#pragma once

#include <fastdds/rtps/RTPSDomain.h>
#include <fastdds/rtps/builtin/data/ReaderProxyData.h>

#include <atomic>
#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "fleetmap/core/ids.hpp"
#include "hello.hpp"
#include "link_end.hpp"
#include "payload.hpp"
#include "qos_file.hpp"
#include "radio_guard.hpp"

namespace fleetmap::bus {

/// A radio or Wi-Fi domain of the fleet: one RTPS participant without DDS discovery, best effort only.
///
/// DDS discovery does not fit 200 kbit/s (docs/reference/dds.md). The fleet is known instead: its addresses
/// from the configuration, its endpoints by name (an entity id is made from a topic's name and type, so both
/// ends compute the same). What remains is who is there and which topics it reads: a Hello of some 200 bytes
/// to each place where a robot may listen, answered by who does not know the sender. Whoever says nothing for
/// the profile's lease is forgotten.
class RadioLink final : public LinkEnd {
 public:
  static Result<std::shared_ptr<LinkEnd>> create(Link link, const DdsBusConfig& config, QosFile qos,
                                                 std::shared_ptr<Executor> executor);
  ~RadioLink() override;
  void take_heard_traffic(std::vector<HeardTraffic>& all) override;
  std::uint64_t discovery_bytes() const override { return hello_bytes_; }
  RadioSurvey survey() const override;
  std::optional<AgentId> robot_of(const Inbox::Sender& sender) const override;

 private:
  class End;
  class HelloListener;
  class DataListener;
  struct Received;
  using Clock = Executor::Clock;
  static constexpr Clock::duration kTick = std::chrono::milliseconds(50);
  using EntityKey = std::uint32_t;
  using Prefix = eprosima::fastrtps::rtps::GuidPrefix_t;
  using Locator = eprosima::fastrtps::rtps::Locator_t;

  /// What a Hello says about this robot.
  struct Acquaintance {
    bool knows_us = false, knows_another = false;
  };
  /// Says Hello from the place of a robot that was heard a moment ago: it was started anew, or is somebody
  /// else.
  struct Successor {
    Prefix robot;
    Hello hello;
    Acquaintance acquaintance;
    Clock::time_point came{};
  };

  /// A place where a robot may listen.
  struct Place {
    Locator locator;
    bool configured = true;  ///< else a robot that the configuration does not name
    std::unique_ptr<eprosima::fastrtps::rtps::WriterHistory> history;
    eprosima::fastrtps::rtps::RTPSWriter* writer = nullptr;  ///< of Hellos to this place
    std::optional<Prefix> robot;                             ///< who was heard from there
    std::optional<Successor> successor;                      ///< waits for `robot` to fall silent
    bool heard = false;                                      ///< a robot was heard here, of whatever version
    bool told = false;                                       ///< that none was
    int said = 0;                                            ///< Hellos since `pause` was set out
    bool asks_again = false;                                 ///< it did not hear our last answer
    /// Who says to be there and has not proved it: the next Hello answers, with its session as challenge.
    std::optional<Prefix> claimed;
    int answers = 0;                                ///< that the claim still gets
    std::optional<trust::Fingerprint> certificate;  ///< of who was last heard from there
    bool lacks_ours = true;                         ///< it has not our certificate
    bool mistakes_us = false;  ///< it knows who was at our place before: Hellos go on until it knows us
    Clock::time_point next{};  ///< Hello; zero: not set out yet, max: none
    Clock::duration pause{};   ///< after it, while nobody answers
  };
  /// A robot that was heard.
  struct Peer {
    AgentId agent;
    Locator locator;
    std::set<EntityKey> reads;
    bool multicast = false;       ///< it listens at the group
    Clock::time_point told{};     ///< when it last got anything from here
    Clock::time_point greeted{};  ///< when it last got a Hello
  };

  RadioLink(Link link, const DdsBusConfig& config, QosFile qos, std::shared_ptr<Executor> executor);
  std::unique_ptr<TopicEnd> make(const Topic& topic, const std::shared_ptr<Inbox>& inbox) override;
  /// What configuration and profiles say.
  Status prepare();
  /// The own address must be there.
  Status join();
  Status make_entities();
  void watch_address(Clock::time_point now);
  Status check_best_effort() const;
  Status add_place(const Locator& locator, bool configured);
  Place* place_at(const Locator& locator);
  bool plausible(const Locator& locator) const;
  /// When it was last heard.
  std::optional<Clock::time_point> last_heard(const Prefix& robot) const;
  bool heard_lately(const Prefix& robot) const;
  std::vector<Prefix> silent() const;
  bool elsewhere(const Place& place) const;
  double others() const;
  double hello_time(double rate) const;
  Clock::duration spread() const;
  Clock::duration first_pause() const;
  bool fleet_is_up() const;
  void count_answer(const Acquaintance& acquaintance);
  void tick();
  void take_successors();
  void take(const Prefix& sender, const Hello& hello, const Acquaintance& acquaintance);
  // With keys (radio_greetings.cpp).
  void take_greeting(const Prefix& sender, const Bytes& greeting);
  void answer_claim(const Prefix& sender, const Locator& from, const trust::Introduction& introduction);
  bool prove(const Prefix& sender, const Locator& from, const Hello& hello,
             const trust::Introduction& introduction);
  Bytes greeting_of(const Hello& hello, const Place& place) const;
  void name_strangers();
  void take_other(const Bytes& cdr);
  void note(const Hello& hello, const Locator& from);
  void compare(const Hello& hello);
  bool first_time(const std::string& warning);
  void refuse(const Locator& from, const std::string& why);
  void refuse_once(const std::string& place, const std::string& why);
  double hello_bits() const;
  void forget(Prefix robot);
  void say_hello(Place& place, bool leaves = false);
  void say_due_hellos(Clock::time_point now);
  void name_who_was_never_heard(Clock::time_point now);
  void reads_changed();
  eprosima::fastrtps::rtps::ReaderProxyData reader_of(const Prefix& robot, const Peer& peer) const;
  Locator group() const;

  const AgentId agent_;
  const std::optional<FleetSettings> settings_;
  const bool observes_;
  const QosFile qos_;
  const std::shared_ptr<RadioGuard> guard_;  ///< null without keys
  eprosima::fastdds::dds::DomainParticipantQos profile_;
  Clock::duration lease_{}, announcement_{};
  const std::shared_ptr<PayloadPool> payloads_ = std::make_shared<PayloadPool>();
  const std::shared_ptr<Received> received_;
  std::unique_ptr<HelloListener> hello_listener_;
  std::unique_ptr<DataListener> data_listener_;
  std::unique_ptr<eprosima::fastrtps::rtps::ReaderHistory> hello_history_, data_history_;
  eprosima::fastrtps::rtps::RTPSParticipant* participant_ = nullptr;
  eprosima::fastrtps::rtps::RTPSReader* data_reader_ = nullptr;
  std::function<void()> stop_timer_;
  Locator own_;  ///< where this robot listens
  std::mt19937 random_{std::random_device{}()};
  std::atomic<std::uint64_t> hello_bytes_ = 0;  ///< sent, on the wire

  // Guarded by mutex_.
  std::vector<std::unique_ptr<Place>> places_;
  std::map<Prefix, Peer> peers_;
  std::map<EntityKey, End*> ends_;
  std::set<EntityKey> reads_;
  Clock::time_point opened_{};       ///< joined
  Clock::time_point next_look_{};    ///< at the own address
  bool address_there_ = true;        ///< at the last look; a change is logged
  Clock::time_point hello_free_{};   ///< no other Hello before
  std::uint32_t hello_writers_ = 0;  ///< made so far
  int answers_ = 0;                  ///< to our Hellos
  Clock::time_point newcomer_{};     ///< when somebody last said Hello who knows nobody here
  std::set<Prefix> namesakes_;       ///< told of in the log
  std::set<std::string> warnings_;   ///< about others, in the log once each
  std::vector<RadioSurvey::Robot> heard_;
  std::vector<std::string> refused_;
};

}  // namespace fleetmap::bus
