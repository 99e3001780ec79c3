#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <vector>

#include "fleetmap/core/time.hpp"
#include "fleetmap/recording/reader.hpp"

namespace fleetmap::apps {

/// A scan, and what gyro and wheels measured since the one before it.
struct SweepInput {
  sensor::Scan scan;
  std::vector<sensor::Imu> imu;
  std::vector<sensor::Wheel> wheels;
};

/// Pairs scans with samples of gyro and wheels. Some recordings hold a scan at its start, before what these
/// measured during its sweep, so scans wait until both have passed their end.
class SweepInputs {
 public:
  /// `capacity` scans may wait; then the oldest gives way to a new one and is counted.
  explicit SweepInputs(std::size_t capacity = std::numeric_limits<std::size_t>::max())
      : capacity_(capacity) {}

  /// Fixes are left out.
  void add(recording::Sample sample);
  /// The next scan, unless it has to wait.
  std::optional<SweepInput> take_due();
  /// The next scan in any case.
  std::optional<SweepInput> take();
  std::uint64_t dropped() const { return dropped_; }

 private:
  struct Waiting {
    sensor::Scan scan;
    Stamp end;  ///< of its sweep
  };
  bool due() const;

  std::size_t capacity_;
  std::deque<Waiting> waiting_;
  std::uint64_t dropped_ = 0;
  std::vector<sensor::Imu> imu_;
  std::vector<sensor::Wheel> wheels_;
  std::optional<Stamp> last_imu_, last_wheel_;
};

}  // namespace fleetmap::apps
