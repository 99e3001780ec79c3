#pragma once

#include <fastdds/rtps/RTPSDomain.h>
#include <fastdds/rtps/builtin/data/ReaderProxyData.h>

#include <array>
#include <atomic>
#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fleetmap/core/ids.hpp"
#include "hello.hpp"
#include "hello_pacing.hpp"
#include "introductions.hpp"
#include "link_end.hpp"
#include "payload.hpp"
#include "qos_file.hpp"
#include "radio_guard.hpp"
#include "radio_notices.hpp"

namespace fleetmap::bus {

/// A radio or Wi-Fi domain of the fleet: one RTPS participant without DDS discovery, best effort only.
///
/// DDS discovery does not fit 200 kbit/s (docs/reference/dds.md). Instead the fleet's addresses come from the
/// configuration, and its endpoints from names (an entity id is made from a topic's name and type, so both
/// ends compute the same). The presence of robots and the topics that they read come from Hellos: some 200
/// bytes to each address where a robot may listen, answered by robots to which the sender is new. A robot
/// that is silent for the profile's lease is dropped.
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
  class Greetings;
  class HelloListener;
  class Hellos;
  class DataListener;
  struct Received;
  using Clock = Executor::Clock;
  static constexpr Clock::duration kTick = std::chrono::milliseconds(50);
  using EntityKey = std::uint32_t;
  using Prefix = eprosima::fastrtps::rtps::GuidPrefix_t;
  using Locator = eprosima::fastrtps::rtps::Locator_t;

  /// The participants that a Hello answers.
  struct Acquaintance {
    bool names_us = false;
    bool names_another = false;  ///< the robot that had our address before
  };
  /// Sends Hellos from the address of a robot that was heard recently: that robot was started again, or this
  /// is another one.
  struct Successor {
    Prefix robot;
    Hello hello;
    Acquaintance acquaintance;
    Clock::time_point came{};
  };

  /// An address at which a robot may listen.
  struct RemoteLocator {
    Locator locator;
    bool configured = true;  ///< else it came in a Hello
    std::unique_ptr<eprosima::fastrtps::rtps::WriterHistory> history;
    eprosima::fastrtps::rtps::RTPSWriter* writer = nullptr;  ///< of Hellos to this address
    std::optional<Prefix> robot;                             ///< that was heard from there, or is said to be
    std::optional<Successor> successor;                      ///< waits until `robot` is silent
    bool heard = false;                                      ///< a robot was heard here, of any version
    bool warned = false;                                     ///< the log reports that none was
    int hellos_sent = 0;                                     ///< since the pause began to grow
    bool missed_answer = false;                              ///< it did not receive our last answer
    /// The participant that claims to be there without proof. The next Hello answers it, with its session as
    /// challenge.
    std::optional<Prefix> claimed;
    int answers = 0;                                ///< that the claim still gets
    std::optional<trust::Fingerprint> certificate;  ///< of the robot last heard from there
    bool lacks_our_certificate = true;
    /// It answers the robot that had our address before; Hellos continue until it answers us.
    bool names_predecessor = false;
    Clock::time_point next{};  ///< Hello; zero: not planned yet, max: none
    Clock::duration pause{};   ///< after it, without an answer
  };
  /// A robot that was heard, or that another one introduced.
  struct Peer {
    AgentId agent;
    Locator locator;
    std::set<EntityKey> reads;
    bool multicast = false;        ///< it listens at the group
    std::uint8_t seeks = 255;      ///< robots it does not know yet, by its last Hello
    bool shares_settings = false;  ///< it has this robot's settings and topics
    Clock::time_point joined{};    ///< when it started, by its last Hello
    /// Another robot introduced it: when it is said to have been heard. Empty once a Hello of its own came.
    std::optional<Clock::time_point> introduced;
    bool spoke = false;              ///< of an introduced one: data came from it
    Clock::time_point last_sent{};   ///< anything, from here to it
    Clock::time_point last_hello{};  ///< from here to it
  };

  RadioLink(Link link, const DdsBusConfig& config, QosFile qos, std::shared_ptr<Executor> executor);
  std::unique_ptr<TopicEnd> make(const Topic& topic, const std::shared_ptr<Inbox>& inbox) override;
  /// Reads configuration and profiles.
  Status prepare();
  /// The own address must be there.
  Status join();
  Status make_entities();
  void watch_address(Clock::time_point now);
  Status check_best_effort() const;
  Status add_remote(const Locator& locator, bool configured);
  RemoteLocator* remote_at(const Locator& locator);
  bool plausible(const Locator& locator) const;
  /// When it was last heard.
  std::optional<Clock::time_point> last_heard(const Prefix& robot) const;
  bool heard_recently(const Prefix& robot) const;
  bool elsewhere(const RemoteLocator& remote) const;
  double others() const;
  std::optional<Locator> origin_of(const std::array<std::uint8_t, 4>& address, std::uint16_t port) const;
  void forget(Prefix robot);
  /// A Hello came from the robot there itself.
  bool heard_itself(const RemoteLocator& remote) const;
  eprosima::fastrtps::rtps::ReaderProxyData reader_of(const Prefix& robot, const Peer& peer) const;
  Locator group() const;

  const AgentId agent_;
  const std::optional<FleetSettings> settings_;
  const bool observes_;
  const QosFile qos_;
  const std::shared_ptr<RadioGuard> guard_;  ///< null without keys
  HelloPacing pacing_;                       ///< guarded by mutex_
  RadioNotices notices_;                     ///< guarded by mutex_
  Introductions introductions_;              ///< guarded by mutex_
  eprosima::fastdds::dds::DomainParticipantQos profile_;
  Clock::duration lease_{}, announcement_{};
  const std::shared_ptr<PayloadPool> payloads_ = std::make_shared<PayloadPool>();
  const std::shared_ptr<Received> received_;
  const std::unique_ptr<Hellos> hellos_;
  const std::unique_ptr<Greetings> greetings_;
  std::unique_ptr<HelloListener> hello_listener_;
  std::unique_ptr<DataListener> data_listener_;
  std::unique_ptr<eprosima::fastrtps::rtps::ReaderHistory> hello_history_, data_history_;
  eprosima::fastrtps::rtps::RTPSParticipant* participant_ = nullptr;
  eprosima::fastrtps::rtps::RTPSReader* data_reader_ = nullptr;
  std::function<void()> stop_timer_;
  Locator own_;                                 ///< the address at which this robot listens
  std::atomic<std::uint64_t> hello_bytes_ = 0;  ///< sent, on the wire

  // Guarded by mutex_.
  std::vector<std::unique_ptr<RemoteLocator>> remotes_;
  std::map<Prefix, Peer> peers_;
  std::map<EntityKey, End*> ends_;
  std::set<EntityKey> reads_;
  Clock::time_point opened_{};              ///< joined
  Clock::time_point next_address_check_{};  ///< at the own address
  bool address_there_ = true;               ///< at the last check; a change is logged
  std::uint32_t hello_writers_ = 0;         ///< made so far
};

}  // namespace fleetmap::bus
