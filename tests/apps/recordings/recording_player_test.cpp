#include "apps/recordings/recording_player.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>

#include "apps/recorded_samples.hpp"
#include "apps/recordings/sample_player.hpp"
#include "bus/dds_domains.hpp"
#include "fleetmap/ros_codec/samples.hpp"

namespace fleetmap::apps {
namespace {

using namespace std::chrono_literals;
using recording::Sample;
using ::testing::HasSubstr;

/// The onboard link of a robot, on which IMU samples of a recording are played.
class RecordingPlayerTest : public ::testing::Test {
 protected:
  static std::unique_ptr<bus::DdsBus> onboard_bus() {
    bus::DdsBusConfig config;
    config.agent = AgentId::parse("r1").value();
    config.qos_directory = std::string(FLEETMAP_SOURCE_DIR) + "/qos";
    config.onboard.domain = bus::testing::first_test_domain();
    config.long_range.enabled = config.short_range.enabled = false;
    return bus::DdsBus::create(config).value();
  }
  /// Samples at these times, ms.
  static std::vector<Sample> imu_at(const std::vector<int>& times) {
    std::vector<Sample> samples;
    for (const int ms : times) {
      sensor::Imu imu;
      imu.stamp = stamp_from_ns(1'000'000'000 + 1'000'000LL * ms);
      samples.emplace_back(imu);
    }
    return samples;
  }
  void SetUp() override {
    const bus::Topic imu = sensor_topics(names_)[1];
    subscription_ = bus_->subscribe(imu, [this](const Bytes& cdr) {
      stamps_.push_back(ros_codec::decode<sensor::Imu>(cdr).value().stamp);
      heard_.push_back(bus_->now());
    });
    bus_->advertise(imu);
    ASSERT_TRUE(bus_->run_until([&] { return bus_->matches(imu).readers > 0; }, 20s));
  }
  bool play_to_end(RecordingPlayer& player, std::size_t samples) {
    return bus_->run_until([&] { return player.done() && stamps_.size() == samples; }, 20s);
  }

  agent::SensorTopics names_;
  std::unique_ptr<bus::DdsBus> bus_ = onboard_bus();
  bus::Handle subscription_;
  std::vector<Stamp> stamps_, heard_;
};

TEST_F(RecordingPlayerTest, PlaysAllInTheirOrderAndNotBeforeTheirTimes) {
  RecordedSamples recording(imu_at({0, 100, 300}));
  RecordingPlayer player(recording, {}, *bus_, names_, 2.0);
  const Stamp begin = bus_->now();
  ASSERT_TRUE(player.start());
  ASSERT_TRUE(play_to_end(player, 3));
  EXPECT_EQ(player.played(), 3u);
  EXPECT_EQ(player.error(), "");
  EXPECT_EQ(stamps_[2] - stamps_[0], 300ms);
  EXPECT_GE(heard_[2] - begin, 150ms) << "at twice the rate";
}

TEST_F(RecordingPlayerTest, UnreadableSampleEndsThePlaybackWithTheReason) {
  RecordedSamples recording(imu_at({0, 10}), "bag.db3: disk image is malformed");
  RecordingPlayer player(recording, {}, *bus_, names_, 1.0);
  ASSERT_TRUE(player.start());
  ASSERT_TRUE(play_to_end(player, 2));
  EXPECT_EQ(player.played(), 2u);
  EXPECT_THAT(player.error(), HasSubstr("disk image is malformed"));
}

TEST_F(RecordingPlayerTest, ARecordingWithoutASampleFails) {
  RecordedSamples recording({});
  RecordingPlayer player(recording, {}, *bus_, names_, 1.0);
  const Status started = player.start();
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().message, "the recording holds no sensor sample");
  EXPECT_TRUE(player.done());
}

}  // namespace
}  // namespace fleetmap::apps
