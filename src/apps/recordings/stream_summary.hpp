#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <ostream>
#include <variant>

#include "fleetmap/recording/reader.hpp"

namespace fleetmap::apps {

/// Number and rate of the samples of each sensor, and the longest gap between two, by their stamps.
class StreamSummary {
 public:
  void add(const recording::Sample& sample);
  /// That fixes came, and none of them with a position, if that is so; empty as well if GPS is not used.
  std::optional<std::string> fixes_without_place(bool uses_gps) const;
  /// A line a sensor.
  void print(std::ostream& out) const;
  std::size_t scans() const { return streams_.front().count; }
  std::size_t imus() const { return streams_[1].count; }
  std::size_t fixes() const { return streams_[2].count; }
  std::size_t wheels() const { return streams_[3].count; }

 private:
  struct Stream {
    std::size_t count = 0;
    std::optional<Stamp> first, last;
    Duration longest_gap = Duration::zero();
  };
  std::size_t places_ = 0;  ///< fixes with a position
  std::array<Stream, std::variant_size_v<recording::Sample>> streams_;
};

}  // namespace fleetmap::apps
