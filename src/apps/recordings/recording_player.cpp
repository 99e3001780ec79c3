#include "recording_player.hpp"

#include <utility>

#include "fleetmap/ros_codec/frame_transforms.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "sample_player.hpp"

namespace fleetmap::apps {

RecordingPlayer::RecordingPlayer(recording::Reader& reader, const recording::Survey& survey, bus::DdsBus& bus,
                                 const agent::SensorTopics& names, double rate)
    : reader_(reader), bus_(bus), names_(names), rate_(rate), times_(survey.clock) {
  for (const bus::Topic& topic : sensor_topics(names_)) bus_.advertise(topic);
  if (const auto mounts = mounts_of(survey.frames); !mounts.empty())
    bus_.publish(ros_codec::topics::tf_static(), ros_codec::encode(mounts));
}

Status RecordingPlayer::start() {
  if (const Status read = advance(); !read) return read;
  if (!next_) return failure("the recording holds no sensor sample");
  first_stamp_ = due_;
  started_ = std::chrono::steady_clock::now();
  timer_ = bus_.every(std::chrono::milliseconds(2), [this] { play_due(); });
  return {};
}

Status RecordingPlayer::advance() {
  auto sample = reader_.next();
  if (!sample) return tl::unexpected(sample.error());
  next_ = std::move(*sample);
  if (next_) due_ = times_.of(*next_, reader_.recorded());
  return {};
}

void RecordingPlayer::play_due() {
  const auto elapsed = std::chrono::steady_clock::now() - started_;
  while (next_ && to_seconds(due_ - first_stamp_) <= rate_ * std::chrono::duration<double>(elapsed).count()) {
    const EncodedSample encoded = encode(*next_, names_);
    bus_.publish(encoded.topic, encoded.cdr);
    ++played_;
    if (const Status read = advance(); !read) {
      error_ = read.error().message;
      next_.reset();
    }
  }
}

}  // namespace fleetmap::apps
