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
  std::array<Stream, std::variant_size_v<recording::Sample>> streams_;
};

}  // namespace fleetmap::apps
