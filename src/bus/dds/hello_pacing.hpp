#pragma once

#include <cstddef>

#include "executor.hpp"
#include "hello_pacing_config.hpp"

namespace fleetmap::bus {

Executor::Clock::duration to_duration(double seconds);

/// Spreads the Hellos of a fleet over time, so that all together keep to their part of a radio's rate.
/// `others` is the number of other robots that share the radio.
class HelloPacing {
 public:
  using Clock = Executor::Clock;
  static constexpr double kNewcomerPause = 0.6;  ///< s between Hellos to a fleet that is connected

  explicit HelloPacing(const HelloPacingConfig& config) : config_(config) {}

  /// The time over which the first Hellos of a fleet that starts at once are spread.
  Clock::duration spread(double others) const;
  /// The pause until a Hello without an answer is repeated; it includes the queue of answers of a fleet that
  /// starts at once, of which each still seeks `sought` robots.
  Clock::duration first_pause(double others, double sought) const;
  /// Hellos to an address that are sent with the first pause, since the radio loses some; later pauses
  /// double.
  int quick_hellos(Clock::time_point now) const;
  /// The pause after the `hellos_sent`-th Hello to an address whose pause is `pause`.
  Clock::duration pause_after(int hellos_sent, Clock::duration pause, Clock::time_point now) const;
  /// Doubles a pause within bounds, of which `announcement` is one.
  Clock::duration longer_pause(Clock::duration pause, double others, Clock::duration announcement) const;
  /// The pause between a Hello of this robot of `bytes` on the wire and its next one.
  Clock::duration pause_between(double others, std::size_t bytes, Clock::time_point now) const;

  /// A Hello of another robot.
  struct Answer {
    bool names_us = false;       ///< it answers ours
    bool names_another = false;  ///< it answers that of the robot which had our address before
    bool joined_before = false;  ///< its sender is no newcomer as we are
  };
  /// True if it shows that the fleet is connected.
  bool count_answer(const Answer& answer, Clock::time_point now);
  /// The others are connected and send no Hellos, so this robot may use more than its own share.
  bool fleet_is_connected(Clock::time_point now) const;

 private:
  double hello_bits() const;
  double hello_time(double others, double sought, double rate) const;

  HelloPacingConfig config_;
  bool joined_late_ = false;  ///< an answer came from a robot that joined before
  Clock::time_point first_answer_{};
  Clock::time_point newcomer_{};  ///< last Hello of a robot that has no peer here
};

}  // namespace fleetmap::bus
