#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fleetmap/recording/reader.hpp"

namespace fleetmap::apps {

/// A recording in memory; with `failure` its rest cannot be read.
class RecordedSamples final : public recording::Reader {
 public:
  explicit RecordedSamples(std::vector<recording::Sample> samples, std::string failure = {})
      : samples_(std::move(samples)), failure_(std::move(failure)) {}
  Result<std::optional<recording::Sample>> next() override {
    if (next_ < samples_.size()) return samples_[next_++];
    if (!std::exchange(ended_, true) && !failure_.empty()) return fleetmap::failure(failure_);
    return std::optional<recording::Sample>();
  }
  const recording::Counters& counters() const override { return counters_; }

 private:
  std::vector<recording::Sample> samples_;
  std::string failure_;
  std::size_t next_ = 0;
  bool ended_ = false;
  recording::Counters counters_;
};

}  // namespace fleetmap::apps
