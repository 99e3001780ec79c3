#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "fleetmap/agent/perception.hpp"
#include "fleetmap/bus/dds_bus.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/recording/play_times.hpp"
#include "fleetmap/recording/reader.hpp"
#include "fleetmap/recording/survey.hpp"

namespace fleetmap::apps {

/// Plays samples at the times they were taken at, from timers of the bus's own thread, and before them the
/// mounts that the recording states.
class RecordingPlayer {
 public:
  RecordingPlayer(recording::Reader& reader, const recording::Survey& survey, bus::DdsBus& bus,
                  const agent::SensorTopics& names, double rate);
  /// Fails if the recording holds no sample.
  Status start();
  bool done() const { return !next_; }
  std::uint64_t played() const { return played_; }
  const std::string& error() const { return error_; }

 private:
  Status advance();
  void play_due();

  recording::Reader& reader_;
  bus::DdsBus& bus_;
  agent::SensorTopics names_;
  double rate_;
  std::optional<recording::Sample> next_;
  recording::PlayTimes times_;
  Stamp due_;  ///< of `next_`
  Stamp first_stamp_;
  std::chrono::steady_clock::time_point started_;
  std::uint64_t played_ = 0;
  std::string error_;
  bus::Handle timer_;
};

}  // namespace fleetmap::apps
