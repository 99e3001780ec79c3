#pragma once

#include "executor.hpp"

namespace fleetmap::bus {

Executor::Clock::duration to_duration(double seconds);

/// Spreads the Hellos of a fleet over time, so that all together keep to their part of a radio's rate.
/// `others` is the number of other robots that share the radio.
class HelloPacing {
 public:
  using Clock = Executor::Clock;
  struct Config {
    double fleet_bits_per_second = 0.0;  ///< of all traffic of all robots
    bool keys = false;                   ///< Hellos are sealed and signed, which takes three instead of two
    bool observes = false;               ///< joins a fleet that may be using the radio
  };
  static constexpr double kNewcomerPause = 0.6;  ///< s between Hellos to a fleet that is connected

  explicit HelloPacing(const Config& config) : config_(config) {}

  /// The time over which the first Hellos of a fleet that starts at once are spread.
  Clock::duration spread(double others) const;
  /// The pause until a Hello without an answer is repeated; it includes the queue of answers of a fleet that
  /// starts at once.
  Clock::duration first_pause(double others) const;
  /// Hellos to an address that are sent with the first pause, since the radio loses some; later pauses
  /// double.
  int quick_hellos(Clock::time_point now) const;
  /// The pause after the `hellos_sent`-th Hello to an address whose pause is `pause`.
  Clock::duration pause_after(int hellos_sent, Clock::duration pause, Clock::time_point now) const;
  /// Doubles a pause within bounds, of which `announcement` is one.
  Clock::duration longer_pause(Clock::duration pause, double others, Clock::duration announcement) const;
  /// The pause between any two Hellos of this robot.
  Clock::duration pause_between(double others, Clock::time_point now) const;

  /// Counts a Hello of another robot; `names_us` if it answers ours, `names_another` if it answers that of
  /// the robot which had our address before. True if it shows that the fleet is connected.
  bool count_answer(bool names_us, bool names_another, Clock::time_point now);
  /// The others are connected and send no Hellos, so this robot may use more than its own share.
  bool fleet_is_connected(Clock::time_point now) const;

 private:
  double hello_bits() const;
  double hello_time(double others, double rate) const;

  Config config_;
  int answers_ = 0;  ///< to our Hellos
  Clock::time_point first_answer_{};
  Clock::time_point newcomer_{};  ///< last Hello of a robot that has no peer here
};

}  // namespace fleetmap::bus
