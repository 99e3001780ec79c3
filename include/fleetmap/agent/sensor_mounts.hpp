#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fleetmap/agent/perception_config.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/sensor/clock_offsets.hpp"
#include "fleetmap/sensor/frame_tree.hpp"

namespace fleetmap::agent {

/// Decides the mounts of LiDAR, IMU and GPS at their first messages. A mount that the configuration states is
/// used whatever /tf_static says, and a difference is a warning; one that it leaves away is that of
/// /tf_static from base_link to the messages' frame_id; without either the sensor is at base_link.
class SensorMounts {
 public:
  enum class State : std::uint8_t {
    kWaits,    ///< for /tf_static: the message must not be used
    kDecided,  ///< by this message
    kKnown,    ///< before, or wheels, which have no mount
  };

  explicit SensorMounts(const PerceptionConfig& config);
  /// The mounts of a recording, before any of its samples is used.
  static SensorMounts of_recording(const sensor::SensorFrames& frames, const PerceptionConfig& config);

  void add(const std::vector<sensor::FrameTransform>& transforms);
  State on_message(sensor::Source source, const std::string& frame_id, Stamp now);
  bool decided(sensor::Source source) const { return of(source).decided; }
  /// Writes a decided mount into `config`, and nothing else; without a source all of them.
  void apply_to(PerceptionConfig& config, sensor::Source source) const;
  void apply_to(PerceptionConfig& config) const;

  /// From base_link to the frames of the sensors: the configured mounts that no other program has published
  /// `frame_patience` after the first message. All of them when there is a new one to be published in
  /// /tf_static, else none. They are recognised when they come back.
  std::vector<sensor::FrameTransform> take_unpublished(Stamp now);

  bool by_frames(sensor::Source source) const { return of(source).by_frames; }
  /// Its pose and what states it, in a line.
  std::string summary(sensor::Source source) const;
  /// The summaries of all decided mounts.
  std::vector<std::string> summaries() const;
  /// Contradictions and missing mounts since the last call, each with its remedy.
  std::vector<std::string> take_warnings();

 private:
  struct Mount {
    Pose T_base_sensor = Pose::Identity();
    bool configured = false;
    bool decided = false;
    bool by_frames = false;
  };
  const Mount& of(sensor::Source source) const { return mounts_[static_cast<std::size_t>(source)]; }
  std::string name_of_frame(sensor::Source source) const;
  void decide(sensor::Source source, const Result<Pose>& by_frames);
  bool published(const sensor::FrameTransform& transform) const;
  /// A warning if another program publishes a frame that is published from here.
  void check_parent(const sensor::FrameTransform& transform);
  void warn(const std::string& text);
  /// A warning if they differ.
  void compare(sensor::Source source, const Pose& by_frames, const std::string& decision);

  std::array<Mount, sensor::kSources> mounts_;
  sensor::SensorFrames frames_;                    ///< of others
  std::vector<sensor::FrameTransform> published_;  ///< from here
  Duration patience_;
  std::optional<Stamp> waits_since_;  ///< the first message of any sensor
  std::vector<std::string> warnings_;
  std::set<std::string> reported_;  ///< a publisher repeats its transforms
};

}  // namespace fleetmap::agent
