#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "fleetmap/core/time.hpp"
#include "fleetmap/exchange/delay_window_config.hpp"

namespace fleetmap::exchange {

/// The least delay of a path within the last one to two minutes: what it takes without any queue.
class BaseDelay {
 public:
  /// s of queueing in a delay of `delay_s`, which counts from now on.
  double queueing_of(double delay_s, Stamp now);

 private:
  double recent_ = std::numeric_limits<double>::infinity();  ///< s, since begun_
  double before_ = std::numeric_limits<double>::infinity();  ///< s, of the history before
  std::optional<Stamp> begun_;
};

/// Number of bytes that may be under way: LEDBAT (RFC 6817) with slow start, driven by the receiver.
/// The bottleneck may be far from the own interface (a channel that others use, a mesh), so its rate shows
/// only in what arrives: the window grows while requests are answered without queueing and shrinks as the
/// queue grows, before the queue overflows.
class DelayWindow {
 public:
  explicit DelayWindow(const DelayWindowConfig& config);

  std::uint32_t bytes() const { return static_cast<std::uint32_t>(window_); }
  /// `bytes` arrived after they waited `queueing_s` on their way.
  void on_arrival(double queueing_s, std::uint32_t bytes);
  /// A chunk requested at `asked` was lost. Losses of one round trip count once. The window is halved if a
  /// queue may have overflowed, else it shrinks by a tenth, since radios also lose without congestion.
  void on_loss(Stamp asked, Stamp now);
  /// True if the recent queueing delay may have overflowed a queue: losses are then attributed to it and not
  /// to a bad link.
  bool queues() const;
  /// From here on it grows by a step a round trip.
  void end_slow_start() { slow_start_ = false; }

 private:
  DelayWindowConfig config_;
  double window_;
  double queueing_ = 0.0;  ///< s, smoothed, of what arrived
  double target_;          ///< s, current target: at most config.target_s, lowered at losses by a full queue
  bool slow_start_ = true;
  std::optional<Stamp> halved_;
};

}  // namespace fleetmap::exchange
