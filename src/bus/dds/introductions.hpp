#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "hello.hpp"

namespace fleetmap::bus {

/// Selects the robots that a Hello introduces, and accepts or refuses introductions by others. Each Hello of
/// a fleet that starts lists the robots that its sender has heard, so that all robots are connected after a
/// few Hellos of each; a Hello to each other robot would fill a radio for ten seconds.
///
/// Introductions age as they are passed on, so that a robot that is gone is soon introduced no more.
class Introductions {
 public:
  using Prefix = std::array<std::uint8_t, 12>;
  static constexpr Duration kFresh = std::chrono::seconds(10);  ///< since any robot heard it
  /// Robots that joined longer ago than this know each other.
  static constexpr Duration kAcquainted = std::chrono::seconds(30);

  /// Records that `sender` is connected to the robots that it introduces.
  void note_known(const Prefix& sender, const std::vector<Introduction>& introduced);
  /// Those of `known` whom a Hello to `recipient` introduces: heard lately and perhaps not known there; those
  /// heard last first, at most kMaxIntroductions. `recipient_joined_ago` is empty if nobody is known there.
  std::vector<Introduction> select(std::vector<Introduction> known, const Prefix& recipient,
                                   std::optional<Duration> recipient_joined_ago) const;
  /// The robot left or was silent for too long. Only itself can make it known again.
  void forget(const Prefix& robot);
  /// A Hello of the robot itself came.
  void meet(const Prefix& robot);
  /// True for one that was heard lately, of a robot that has not left since.
  bool accepts(const Introduction& introduction) const;

 private:
  std::map<Prefix, std::set<Prefix>> knows_;  ///< peers that each peer's Hellos listed
  std::deque<Prefix> gone_;
};

}  // namespace fleetmap::bus
