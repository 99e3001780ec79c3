#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fleetmap::messages {

/// Problems of a robot and the clock of its sensors, in the three bytes that alignment leaves unused in an
/// AgentStatus.
struct Health {
  enum Problem : std::uint8_t {
    kNoScan = 1,           ///< the LiDAR is silent
    kScansNotMatched = 2,  ///< by the odometry, since the start
    kScansDropped = 4,     ///< because the odometry is too slow, since the start
    kDiskRefuses = 8,      ///< writes, since the start
    kNoPose = 16,          ///< G is not known
  };
  static constexpr std::uint8_t kAllProblems = 31;
  static constexpr std::uint8_t kSensors = 4;

  std::uint8_t problems = 0;      ///< bits of Problem
  std::uint8_t clock_sensor = 0;  ///< the sensor whose clock is off most (sensor::Source)
  std::int8_t clock_offset = 0;   ///< clock_code() of it; 0: not known
  bool operator==(const Health&) const = default;
};

/// Class of the seconds by which a clock is behind (negative: ahead): |code| - 1 is log2 of the milliseconds,
/// rounded; up to 1 ms is class 1.
std::int8_t clock_code(double behind);
/// The seconds of a class; nothing for 0.
std::optional<double> seconds_behind(std::int8_t clock_code);
/// The problems in words, the worst one first.
std::vector<std::string> words_of(const Health& health);

}  // namespace fleetmap::messages
