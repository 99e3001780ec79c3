#pragma once

#include <filesystem>
#include <optional>

#include "fleetmap/recording/reader_config.hpp"

namespace fleetmap::config {

/// The recording of one robot and its place in the time of the run.
struct RecordingConfig {
  std::filesystem::path path;
  recording::ReaderConfig reader;
  /// s, when the recording's first sample is played, counted from the start of the run. Empty: recordings
  /// that began within an hour of each other keep their times, others all start at 0.
  std::optional<double> start;
};

}  // namespace fleetmap::config
