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
#include "fleetmap/bus/dds_bus_config.hpp"
#include "fleetmap/bus/dds_link_config.hpp"
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

/// Traffic from one robot over one radio in some time.
struct HeardTraffic {
  Link link = Link::kLongRange;
  AgentId from;
  std::uint64_t messages = 0;
  std::uint64_t hellos = 0;  ///< beside the messages: it is there
  std::uint64_t bytes = 0;   ///< of the messages, on the wire, by wire_bytes()
  std::uint64_t lost = 0;    ///< messages that its writers numbered and that did not come, or came overtaken
  std::uint64_t timed = 0;   ///< messages that carry a time of publication
  /// Their mean from that to here, by the clocks of both machines.
  Duration delay = Duration::zero();
};

/// A robot's Bus over Fast DDS: a participant per enabled link.
///
/// The thread inside `run` or `run_until` is the bus's callback thread. Messages that arrive meanwhile or
/// before wait in bounded queues. Members may be called from that thread, or from any one thread while none
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

  /// Waits for the work items under way and drops the waiting ones, for good: afterwards no offloaded work
  /// runs any more, so its owner may be destroyed. Call it while no thread runs the bus.
  void finish_work();

  /// Runs `callback` on the callback thread; false, and it does not, while thousands of them wait.
  bool post(Work callback);

  /// Runs callbacks until `stop()`, which may have been called already.
  void run();
  /// Runs callbacks until `stop` is set, for instance by a signal handler, or `stop()` is called; checks the
  /// flag after each callback and every 100 ms.
  void run_until(const std::atomic<bool>& stop);
  /// Runs callbacks until `done()` returns true, which is called before the first and after each; false if
  /// `timeout` came first.
  bool run_until(const std::function<bool()>& done, Duration timeout);
  void stop();

  /// Counterparts on other participants (onboard: on this one as well) of this bus's ends of a topic.
  struct Matches {
    std::size_t readers = 0;  ///< that our writer has found
    std::size_t writers = 0;  ///< that our reader has found
  };
  Matches matches(const Topic& topic) const;

  /// Traffic over the radios since the last call, of each robot that sent anything.
  std::vector<HeardTraffic> take_heard_traffic();
  /// The robots heard on a radio, from any thread. Empty onboard and on a link that is not enabled.
  RadioSurvey survey(Link link) const;

  /// Features that the links run without because of limits of this machine, with the remedy.
  std::vector<std::string> warnings() const;

  /// Counts how often the callback thread and the threads of the lanes were stuck in one piece of work, from
  /// any thread. The log reports each.
  std::vector<StallCounters> stalls() const;

 private:
  struct State;
  explicit DdsBus(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace fleetmap::bus
