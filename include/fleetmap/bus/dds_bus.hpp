#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/bus/bus.hpp"
#include "fleetmap/bus/fleet_settings.hpp"
#include "fleetmap/bus/radio_survey.hpp"
#include "fleetmap/bus/stall_detector.hpp"
#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::trust {
struct Credentials;
}

namespace fleetmap::bus {

/// The profiles that qos/<link>.xml must define, each as a data writer and as a data reader.
const std::vector<std::string>& profiles_of(Link link);

/// What differs from run to run on one link; everything else is policy and lives in qos/<link>.xml.
struct DdsLinkConfig {
  bool enabled = true;       ///< a link that is not: publishing counts as dropped, subscribing is silent
  std::uint32_t domain = 0;  ///< DDS domain id in [0, 230]
  /// IPv4 address of the own interface to use, and no other. Empty: the loopback onboard, every interface on
  /// radios.
  std::string address = {};
  /// Where others may be: "10.0.0.2" or "10.0.0.2:7412", a port being that of discovery
  /// (docs/reference/dds.md). Empty: as the profile says, or else this machine. Onboard the loopback's
  /// multicast group is asked as well.
  std::vector<std::string> peers = {};
  std::uint32_t participants_per_peer =
      0;  ///< how many participant ids to try on a peer; 0: as the profile says
  /// On radios: what is for all goes out once, to a multicast group; false: a datagram for each robot. All
  /// robots must have it alike, and the medium must carry multicast between them.
  bool multicast = false;
  /// On radios: DDS domains in whose ports others are looked for besides, at the addresses of `peers`.
  std::vector<std::uint32_t> other_domains = {};
  /// On radios: bit/s that all robots together may send; their Hellos keep to a part of it.
  double fleet_bits_per_second = 145e3;
  std::size_t queue_messages = 256;     ///< of one topic waiting for their callback; the oldest gives way
  std::size_t queue_bytes = 64u << 20;  ///< the same in bytes; one message always fits
  bool shared_memory = true;            ///< false leaves out the profile's shared memory transports
};

struct DdsBusConfig {
  AgentId agent;
  std::filesystem::path qos_directory;  ///< holds onboard.xml, long_range.xml, short_range.xml
  DdsLinkConfig onboard{.domain = 0};
  DdsLinkConfig long_range{.domain = 1};
  DdsLinkConfig short_range{.domain = 2, .fleet_bits_per_second = 1450e3};
  std::optional<FleetSettings> settings = {};  ///< of a robot, that others compare with theirs
  /// On radios: listens, but not at a robot's port (the first of its address), and finds others faster.
  bool observes = false;
  /// On radios: all that is sent is sealed, and only members of the fleet are heard. Empty: anyone is.
  std::shared_ptr<const trust::Credentials> keys = {};
  /// Names the field and the rule that it breaks.
  Status validate() const;
};
/// The settings of one of its links.
const DdsLinkConfig& config_of(const DdsBusConfig& config, Link link);

/// What came from one robot over one radio in some time.
struct HeardTraffic {
  Link link = Link::kLongRange;
  AgentId from;
  std::uint64_t messages = 0;
  std::uint64_t hellos = 0;  ///< beside the messages: it is there
  std::uint64_t bytes = 0;   ///< of the messages, on the wire, by wire_bytes()
  std::uint64_t lost = 0;    ///< messages that its writers numbered and that did not come, or came overtaken
  /// Mean from its publishing to here, by the clocks of both machines.
  Duration delay = Duration::zero();
};

/// A robot's Bus over Fast DDS: a participant per enabled link.
///
/// The thread that is in `run` or `run_until` is the bus's callback thread. Messages that arrive meanwhile or
/// before wait in bounded queues. Members may be called from that thread, or from any one thread while nobody
/// runs the bus (to wire components up); `post`, `stop`, `publish`, `matches`, `survey` and `stats` from any
/// thread. A topic that names a profile which its link's file lacks, or one name with two types, is a bug and
/// throws std::logic_error.
class DdsBus final : public Bus {
 public:
  /// Fails with file, line, profile and remedy if the profiles are not as they should be, and with link and
  /// reason if a participant cannot be made (address that this machine has not, ports taken).
  static Result<std::unique_ptr<DdsBus>> create(const DdsBusConfig& config);
  /// Finishes the work item under way; work, messages and callbacks that wait are let go.
  ~DdsBus() override;

  /// The system's time when the bus was made, and what has passed since: a clock that is set meanwhile stops
  /// and repeats nothing.
  Stamp now() const override;
  void advertise(const Topic& topic) override;
  void publish(const Topic& topic, const Bytes& cdr) override;
  [[nodiscard]] Handle subscribe(const Topic& topic, OnMessage on_message) override;
  std::optional<AgentId> sender() const override;
  [[nodiscard]] Handle every(Duration period, Work callback) override;
  bool offload(Lane lane, Work work, std::function<void()> done) override;
  std::vector<TopicStats> stats() const override;
  std::uint64_t discovery_bytes(Link link) const override;

  /// Waits for the work items under way and lets the waiting ones go, for good: afterwards nothing that was
  /// offloaded runs any more, so its owner may be destroyed. Call it while nobody runs the bus.
  void finish_work();

  /// Runs `callback` on the callback thread; false, and it does not, while thousands of them wait.
  bool post(Work callback);

  /// Runs callbacks until `stop()`, which may have been called already.
  void run();
  /// Runs callbacks until `stop` is set, for instance by a signal handler, or `stop()` is called; looks at
  /// the flag after each callback and every 100 ms.
  void run_until(const std::atomic<bool>& stop);
  /// Runs callbacks until `done()`, which is asked before the first and after each; false if `timeout` came
  /// first.
  bool run_until(const std::function<bool()>& done, Duration timeout);
  void stop();

  /// Counterparts on other participants (onboard: on this one as well) of this bus's ends of a topic.
  struct Matches {
    std::size_t readers = 0;  ///< that our writer has found
    std::size_t writers = 0;  ///< that our reader has found
  };
  Matches matches(const Topic& topic) const;

  /// What came over the radios since the last call, of each robot that sent anything.
  std::vector<HeardTraffic> take_heard_traffic();
  /// Who was heard on a radio, from any thread. Empty onboard and on a link that is not enabled.
  RadioSurvey survey(Link link) const;

  /// What the links run without because this machine has not enough of it, with the remedy.
  std::vector<std::string> warnings() const;

  /// How often the callback thread and the threads of the lanes were stuck in one piece of work, from any
  /// thread. The log tells of each.
  std::vector<StallCounters> stalls() const;

 private:
  struct State;
  explicit DdsBus(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace fleetmap::bus
