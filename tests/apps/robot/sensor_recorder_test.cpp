#include "robot/sensor_recorder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fleetmap/bus/local_network.hpp"
#include "fleetmap/recording/reader.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "recordings/sample_player.hpp"
#include "support/full_disk.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

class SensorRecorderTest : public ::testing::Test {
 protected:
  std::unique_ptr<SensorRecorder> recorder() {
    return std::move(SensorRecorder::create({directory_.string(), {}}, topics_, true, robot_).value());
  }
  /// An IMU sample and a fix.
  void publish(std::int64_t ms) {
    sensor::Imu imu;
    imu.stamp = stamp_from_ns(1'000'000 * ms);
    imu.specific_force = {0.0, 0.0, 9.81};
    sensor::Fix fix;
    fix.stamp = imu.stamp;
    fix.position = geo_point_from_degrees(39.0, -3.0, 600.0);
    fix.covariance = Eigen::Matrix3d::Identity();
    for (const recording::Sample& sample : {recording::Sample(imu), recording::Sample(fix)}) {
      const EncodedSample encoded = encode(sample, topics_);
      robot_.publish(encoded.topic, encoded.cdr);
    }
    network_->run_until(network_->now() + std::chrono::milliseconds(10));
  }
  static recording::Counters counters_of(const std::filesystem::path& bag) {
    recording::ReaderConfig config;
    config.scans_needed = false;
    auto reader = recording::open(bag, config);
    EXPECT_TRUE(reader) << reader.error().message;
    if (!reader) return {};
    while (*(*reader)->next()) {
    }
    return (*reader)->counters();
  }

  std::unique_ptr<bus::LocalNetwork> network_ = bus::LocalNetwork::create({}).value();
  bus::Bus& robot_ = network_->add_robot(AgentId::parse("r1").value());
  agent::SensorTopics topics_;
  testing::TemporaryFolder folder_;
  std::filesystem::path directory_ = folder_.path() / "bag";
};

TEST_F(SensorRecorderTest, SamplesBeforeTheCloseAreInTheBag) {
  const auto recording = recorder();
  for (const int ms : {1000, 1100, 1200}) publish(ms);
  ASSERT_TRUE(recording->close());
  publish(1300);
  const recording::Counters counters = counters_of(directory_);
  EXPECT_EQ(counters.imus, 3u);
  EXPECT_EQ(counters.fixes, 3u);
  EXPECT_EQ(counters.undecodable_messages, 0u);
}

TEST_F(SensorRecorderTest, ABagOfAnEarlierStartIsKept) {
  auto recording = recorder();
  publish(1000);
  ASSERT_TRUE(recording->close());
  recording = recorder();
  for (const int ms : {2000, 2100}) publish(ms);
  ASSERT_TRUE(recording->close());
  EXPECT_EQ(counters_of(directory_).imus, 1u);
  EXPECT_EQ(counters_of(directory_.string() + "-1").imus, 2u);
}

TEST_F(SensorRecorderTest, AFullDiskIsItsProblem) {
  const auto recording = recorder();
  publish(1000);
  EXPECT_EQ(recording->problem(), "");
  {
    const testing::FullDisk disk(1 << 16);
    for (int k = 0; k < 2000 && recording->problem().empty(); ++k) publish(1000 + k);
    static_cast<void>(recording->close());
  }
  EXPECT_NE(recording->problem(), "");
}

// config/rviz/fleetmap.rviz asks for what is kept, of a robot and of a recording that is played.
TEST(SensorRecorderDurability, IsThatOfThePublishers) {
  for (const bus::Topic& topic : {ros_codec::topics::submaps(), ros_codec::topics::map(),
                                  ros_codec::topics::path(), ros_codec::topics::markers()})
    EXPECT_EQ(durability_of(topic), recording::Durability::kTransientLocal) << topic.name;
  EXPECT_EQ(durability_of(ros_codec::topics::points()), recording::Durability::kVolatile);
}

}  // namespace
}  // namespace fleetmap::apps
