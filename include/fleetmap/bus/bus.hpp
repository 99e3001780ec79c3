#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fleetmap/bus/link.hpp"
#include "fleetmap/bus/work.hpp"
#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/time.hpp"

namespace fleetmap::bus {

/// A stream of messages of one IDL type. Two topics with the same link and name must have the same type and
/// profile.
struct Topic {
  Link link = Link::kOnboard;
  std::string name;     ///< as on the wire: "rt/points", "fleetmap/node", to one robot "fleetmap/hold/r2"
  std::string type;     ///< IDL type as on the wire: "sensor_msgs::msg::dds_::PointCloud2_"
  std::string profile;  ///< names the data writer and data reader profiles in qos/<link>.xml
};

/// Counters of one topic since the bus was made.
struct TopicStats {
  std::string topic;
  Link link = Link::kOnboard;
  std::uint64_t sent_messages = 0;
  std::uint64_t sent_bytes = 0;  ///< CDR payload, once per publish
  std::uint64_t received_messages = 0;
  std::uint64_t received_bytes = 0;
  std::uint64_t dropped_messages = 0;  ///< by a full queue, here
};

/// Cancels its subscription or timer when destroyed.
class Handle {
 public:
  Handle() = default;
  explicit Handle(std::function<void()> cancel) : cancel_(std::move(cancel)) {}
  Handle(Handle&& other) noexcept : cancel_(std::exchange(other.cancel_, nullptr)) {}
  Handle& operator=(Handle&& other) noexcept {
    if (this != &other) {
      reset();
      cancel_ = std::exchange(other.cancel_, nullptr);
    }
    return *this;
  }
  ~Handle() { reset(); }
  void reset() {
    if (auto cancel = std::exchange(cancel_, nullptr)) cancel();
  }

 private:
  std::function<void()> cancel_;
};

/// Lanes of long work. Items of one lane run in order, one at a time; lanes run in parallel, so that slow
/// background work does not delay the sensors.
enum class Lane : std::uint8_t { kPerception, kBackground };

/// The environment of a robot's components: topics of CDR-encoded IDL messages, a clock, timers and lanes for
/// long work. All callbacks of one Bus (one robot) run one after the other, on one thread; all members are
/// called from that thread, with exceptions as noted. Messages published by a robot are delivered to its own
/// subscribers on the onboard link only.
class Bus {
 public:
  using OnMessage = std::function<void(const Bytes& cdr)>;

  virtual ~Bus() = default;

  virtual Stamp now() const = 0;

  /// Makes the sending end of `topic` ready (discovery takes a moment), so that the first message finds its
  /// readers.
  virtual void advertise(const Topic& topic) { static_cast<void>(topic); }

  /// Hands `cdr` (with its encapsulation header) to the link. Never blocks: what does not fit is dropped and
  /// counted.
  virtual void publish(const Topic& topic, const Bytes& cdr) = 0;
  [[nodiscard]] virtual Handle subscribe(const Topic& topic, OnMessage on_message) = 0;
  /// During a callback of subscribe(): the robot that sent the message, if the link can identify it. Empty
  /// onboard. A member of the fleet that changed its program can send under another robot's name.
  virtual std::optional<AgentId> sender() const = 0;

  /// Calls `callback` at now() + period, and again every period, until the handle goes.
  [[nodiscard]] virtual Handle every(Duration period, Work callback) = 0;

  /// Items of a lane that may wait.
  static constexpr std::size_t kMaxWork = 256;

  /// Runs `work` off the callback thread, then `done` on it. In virtual time `done` follows after a set time,
  /// so results do not depend on the machine. Returns false, and runs neither, while kMaxWork items of the
  /// lane wait.
  virtual bool offload(Lane lane, Work work, std::function<void()> done) = 0;

  virtual std::vector<TopicStats> stats() const = 0;

  /// B on the wire that the link itself has sent to find other robots, beside what was published, since the
  /// bus was made.
  virtual std::uint64_t discovery_bytes(Link link) const {
    static_cast<void>(link);
    return 0;
  }
};

}  // namespace fleetmap::bus
