#include "recording_section.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace fleetmap::config {
namespace {

using ::testing::HasSubstr;

struct RecordingReading {
  std::optional<RecordingConfig> recording;
  std::string problems;
};

RecordingReading recording_of(const std::string& recording) {
  Document document = Document::from(YAML::Load("{recording: {" + recording + "}}"), "field/r1.yaml");
  Section top(document, document.root(), "");
  RecordingReading reading{read_recording(top), ""};
  if (const Status status = document.status(); !status) reading.problems = status.error().message;
  return reading;
}

TEST(RecordingSection, IsAbsentWithoutItsKey) {
  Document document = Document::from(YAML::Load("{id: r1}"), "r1.yaml");
  Section top(document, document.root(), "");
  EXPECT_FALSE(read_recording(top));
  EXPECT_TRUE(document.status());
  EXPECT_TRUE(top.known_keys().contains("recording"));
}

TEST(RecordingSection, NeedsNoMoreThanAPath) {
  const RecordingReading reading = recording_of("path: drive.bag");
  ASSERT_EQ(reading.problems, "");
  EXPECT_EQ(reading.recording->path, "field/drive.bag");
  EXPECT_EQ(reading.recording->start, std::nullopt) << "recordings keep their times";
  EXPECT_EQ(reading.recording->reader.kitti.first_frame, 0u);
  EXPECT_EQ(reading.recording->reader.kitti.last_frame, std::numeric_limits<std::size_t>::max());
  EXPECT_FALSE(reading.recording->reader.kitti.fix_degradation);
  EXPECT_EQ(reading.recording->reader.topics.points, "");
}

TEST(RecordingSection, EveryKeyIsRead) {
  const RecordingReading reading = recording_of(
      "path: /data/0005, start: 0, frames: [3, 9], frame_rate: 20,"
      " gps_error: {sigma: 2, correlation_time: 30, seed: 4},"
      " topics: {points: /velodyne, imu: none, fix: /gps, wheel: /odom}");
  ASSERT_EQ(reading.problems, "");
  const RecordingConfig& recording = *reading.recording;
  EXPECT_EQ(recording.path, "/data/0005");
  EXPECT_EQ(recording.start, 0.0);
  EXPECT_EQ(recording.reader.kitti.first_frame, 3u);
  EXPECT_EQ(recording.reader.kitti.last_frame, 9u);
  EXPECT_EQ(recording.reader.kitti.nominal_rate, 20.0);
  ASSERT_TRUE(recording.reader.kitti.fix_degradation);
  EXPECT_EQ(recording.reader.kitti.fix_degradation->sigma, 2.0);
  EXPECT_EQ(recording.reader.kitti.fix_degradation->correlation_time, 30.0);
  EXPECT_EQ(recording.reader.kitti.fix_degradation->seed, 4u);
  EXPECT_EQ(recording.reader.topics.points, "/velodyne");
  EXPECT_EQ(recording.reader.topics.imu, "none");
  EXPECT_EQ(recording.reader.topics.fix, "/gps");
  EXPECT_EQ(recording.reader.topics.wheel, "/odom");
}

TEST(RecordingSection, ProblemsNameTheKey) {
  EXPECT_THAT(recording_of("").problems,
              HasSubstr("recording.path: expected the folder or file of a recording"));
  EXPECT_THAT(recording_of("path: x, start: -1").problems,
              HasSubstr("recording.start: expected seconds >= 0"));
  for (const char* frames : {"[4, 3]", "[-1, 3]", "[0, 1.5]", "[0.5, 2]", "[3, 1e30]"}) {
    EXPECT_THAT(recording_of(std::string("path: x, frames: ") + frames).problems,
                HasSubstr("recording.frames: expected [first, last] with 0 <= first <= last"))
        << frames;
  }
  EXPECT_EQ(recording_of("path: x, frames: [3, 3]").problems, "") << "a single frame";
  EXPECT_THAT(recording_of("path: x, gps_error: {sgma: 1}").problems,
              HasSubstr("recording.gps_error.sgma: unknown key; did you mean 'sigma'?"));
  EXPECT_THAT(recording_of("path: x, frame_rate: 0").problems,
              HasSubstr("recording.frame_rate must be a positive number of frames per second"));
  EXPECT_THAT(recording_of("path: x, gps_error: {sigma: 0}").problems,
              HasSubstr("recording.gps_error.sigma must"));
  EXPECT_THAT(recording_of("path: x, topics: {point: /p}").problems, HasSubstr("did you mean 'points'?"));
}

}  // namespace
}  // namespace fleetmap::config
