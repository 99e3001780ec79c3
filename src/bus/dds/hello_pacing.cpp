#include "hello_pacing.hpp"

#include <algorithm>

namespace fleetmap::bus {
namespace {

/// On the wire, each of the two Hellos by which a pair meets; with keys there are three in the mean.
constexpr double kHelloBits = 8.0 * 260.0, kGreetingBits = 8.0 * 345.0 * 3.0 / 2.0;
/// The part of the link's fleet_bits_per_second that the Hellos of all robots may take: in the mean while a
/// fleet starts, and in any second.
constexpr double kMeanPart = 0.43, kMaxPart = 0.85;
constexpr double kMaxSpread = 6.0;                   // s, so that a fleet is connected within ten
constexpr double kFirstPause = 0.5;                  // s, of a pair alone
constexpr auto kMaxPause = std::chrono::seconds(2);  // and a second for each other robot
/// A robot that joins a connected fleet sends Hellos faster, since the others send none, unless another
/// newcomer sent a Hello a while ago. Robots that start together are no such fleet: some may be off, and all
/// seek them.
constexpr auto kNoNewcomer = std::chrono::seconds(10);
constexpr double kNewcomerShares = 5.0;
/// Later than this after its first answer, or if others came as well, it leaves them more.
constexpr auto kNewcomerFor = std::chrono::seconds(10);
constexpr double kLaterShares = 2.0;
/// A radio that loses one datagram in five loses one of a pair's two Hellos in a third of the tries: with
/// twelve, one of 200,000 pairs is still apart, with seven one of 1,300.
constexpr int kQuickHellos = 7, kNewcomerHellos = 12;

}  // namespace

Executor::Clock::duration to_duration(double seconds) {
  return std::chrono::duration_cast<Executor::Clock::duration>(std::chrono::duration<double>(seconds));
}

double HelloPacing::hello_bits() const { return config_.keys ? kGreetingBits : kHelloBits; }

/// s that the Hellos of a fleet that starts at once, each robot's to `sought` others, take at `rate` (bit/s).
double HelloPacing::hello_time(double others, double sought, double rate) const {
  return sought * (others + 1.0) * hello_bits() / rate;
}

HelloPacing::Clock::duration HelloPacing::spread(double others) const {
  if (config_.observes) return {};
  return to_duration(
      std::min(hello_time(others, others, kMeanPart * config_.fleet_bits_per_second), kMaxSpread));
}

HelloPacing::Clock::duration HelloPacing::first_pause(double others, double sought) const {
  // A share of the time that all Hellos take at the highest rate. Three messages are lost more often than
  // two, so with keys a repetition pays earlier.
  const double answered = config_.keys ? 0.4 : 0.75;
  return to_duration(kFirstPause +
                     (config_.observes
                          ? 0.0
                          : answered * hello_time(others, sought, kMaxPart * config_.fleet_bits_per_second)));
}

int HelloPacing::quick_hellos(Clock::time_point now) const {
  return fleet_is_connected(now) ? kNewcomerHellos : kQuickHellos;
}

HelloPacing::Clock::duration HelloPacing::pause_after(int hellos_sent, Clock::duration pause,
                                                      Clock::time_point now) const {
  return fleet_is_connected(now) && hellos_sent < kNewcomerHellos
             ? std::min(pause, to_duration(kNewcomerPause))
             : pause;
}

HelloPacing::Clock::duration HelloPacing::longer_pause(Clock::duration pause, double others,
                                                       Clock::duration announcement) const {
  // In a small fleet a robot that comes into reach again must be found within ten seconds.
  const Clock::duration min_pause = to_duration(kFirstPause);
  const Clock::duration max_pause = std::min<Clock::duration>(announcement, kMaxPause + to_duration(others));
  return std::clamp(2 * pause, min_pause, std::max(max_pause, min_pause));
}

HelloPacing::Clock::duration HelloPacing::pause_between(double others, std::size_t bytes,
                                                        Clock::time_point now) const {
  const bool only_one = newcomer_ == Clock::time_point{} && now - first_answer_ < kNewcomerFor;
  const double max_shares = only_one ? kNewcomerShares : kLaterShares;
  const double shares = fleet_is_connected(now) ? std::min(max_shares, others + 1.0) : 1.0;
  // With keys a Hello counts for the three that a pair needs.
  const double bits = config_.keys ? kGreetingBits : 8.0 * static_cast<double>(bytes);
  return to_duration((others + 1.0) * bits / (shares * kMaxPart * config_.fleet_bits_per_second));
}

bool HelloPacing::fleet_is_connected(Clock::time_point now) const {
  const bool alone = newcomer_ == Clock::time_point{} || now - newcomer_ > kNoNewcomer;
  return !config_.observes && alone && joined_late_;
}

bool HelloPacing::count_answer(const Answer& answer, Clock::time_point now) {
  const bool was_connected = fleet_is_connected(now);
  if (answer.names_us) {
    if (first_answer_ == Clock::time_point{}) first_answer_ = now;
    joined_late_ |= answer.joined_before;
  } else if (!answer.names_another && !answer.joined_before) {
    newcomer_ = now;
  }
  return !was_connected && fleet_is_connected(now);
}

}  // namespace fleetmap::bus
