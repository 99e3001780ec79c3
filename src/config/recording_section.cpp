#include "recording_section.hpp"

#include <cmath>

namespace fleetmap::config {

std::optional<RecordingConfig> read_recording(Section& top) {
  if (!top.has("recording")) return std::nullopt;
  RecordingConfig recording;
  Section section = top.section("recording");
  section.read_path("path", recording.path);
  if (recording.path.empty()) section.problem("path", "expected the folder or file of a recording");
  if (section.has("start")) {
    double start = 0.0;
    section.read("start", start);
    if (start < 0.0) section.problem("start", "expected seconds >= 0");
    recording.start = start;
  }
  if (const auto frames = section.numbers("frames", 2)) {
    constexpr double kMaxFrame = 1e9;
    const bool whole = (*frames)[0] >= 0 && (*frames)[1] >= (*frames)[0] && (*frames)[1] <= kMaxFrame &&
                       std::floor((*frames)[0]) == (*frames)[0] && std::floor((*frames)[1]) == (*frames)[1];
    if (!whole) section.problem("frames", "expected [first, last] with 0 <= first <= last <= 1e9");
    if (whole) recording.reader.kitti.first_frame = static_cast<std::size_t>((*frames)[0]);
    if (whole) recording.reader.kitti.last_frame = static_cast<std::size_t>((*frames)[1]);
  }
  section.read("frame_rate", recording.reader.kitti.nominal_rate);
  if (section.has("gps_error")) {
    recording::FixDegradation degradation;
    Section error = section.section("gps_error");
    error.read("sigma", degradation.sigma);
    error.read("correlation_time", degradation.correlation_time);
    error.read("seed", degradation.seed);
    error.finish();
    recording.reader.kitti.fix_degradation = degradation;
  }
  Section topics = section.section("topics");
  topics.read("points", recording.reader.topics.points);
  topics.read("imu", recording.reader.topics.imu);
  topics.read("fix", recording.reader.topics.fix);
  topics.read("wheel", recording.reader.topics.wheel);
  topics.finish();
  section.finish();
  section.check(recording.reader.validate());
  return recording;
}

}  // namespace fleetmap::config
