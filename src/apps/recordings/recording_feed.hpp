#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fleetmap/config/recording_config.hpp"
#include "fleetmap/recording/play_times.hpp"
#include "sample_player.hpp"
#include "twin/fleet_feed.hpp"

namespace fleetmap::apps {

/// Plays each member's recording.
class RecordingFeed final : public FleetFeed {
 public:
  /// `log_clocks`: of each recording. `site_origin`: as configured; else the first fix of the first recording
  /// that the fixes after it bear out.
  static Result<std::unique_ptr<RecordingFeed>> create(const std::vector<config::RecordingConfig>& recordings,
                                                       const std::vector<recording::LogClock>& log_clocks,
                                                       const std::optional<GeoPoint>& site_origin,
                                                       const std::vector<bool>& uses_gps = {});

  Stamp start() const override { return start_; }
  std::optional<GeoPoint> origin() const override { return origin_; }
  Status begin(bus::LocalNetwork& network, Deliver deliver) override;
  bool ended(std::size_t member) const override { return !members_[member].next.has_value(); }
  std::string problem(std::size_t member) const override { return members_[member].problem; }
  recording::Counters counters(std::size_t member) const override {
    return members_[member].reader->counters();
  }
  std::vector<std::string> findings(std::size_t member) const override {
    return members_[member].reader->findings();
  }
  std::optional<bus::EnuPosition> position(std::size_t) const override { return std::nullopt; }

 private:
  struct Member {
    std::unique_ptr<recording::Reader> reader;
    std::optional<recording::Sample> next;
    recording::PlayTimes times;
    Stamp due;         ///< time of playing of `next`
    Duration shift{};  ///< virtual time = time of playing + shift
    std::string problem;
  };
  RecordingFeed() = default;
  static Status advance(Member& member);
  Status find_origin(const config::RecordingConfig& recording);
  void set_shifts(const std::vector<config::RecordingConfig>& recordings);
  void schedule(std::size_t member);
  void play(std::size_t member);

  std::vector<Member> members_;
  std::optional<GeoPoint> origin_;
  Stamp start_{};
  bus::LocalNetwork* network_ = nullptr;
  Deliver deliver_;
};

}  // namespace fleetmap::apps
