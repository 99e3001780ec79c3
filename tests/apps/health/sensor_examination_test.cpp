// `fleetmap doctor` beside drivers: it hears what an agent would, and names what is wrong.
#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "bus/dds_domains.hpp"
#include "fleetmap/bus/dds_bus.hpp"
#include "fleetmap/core/utc.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "support/command_line.hpp"
#include "support/gpsd_server.hpp"
#include "support/livox_message.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

class SensorExamination : public ::testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(file_) << "id: r1\nfleet: [r1, r2]\ndirectory: " << (folder_.path() / "r1").string()
                         << "\ndds:\n  qos: " << FLEETMAP_SOURCE_DIR
                         << "/qos\n  onboard: {domain: " << kDomain
                         << "}\n  long_range: {domain: " << kDomain + 1
                         << ", peers: [127.0.0.1]}\n  short_range: {domain: " << kDomain + 2
                         << ", peers: [127.0.0.1]}\n";
  }
  testing::Process doctor(const std::string& seconds) const {
    return testing::Process({testing::kProgram, "doctor", "-c", file_.string(), "--seconds", seconds});
  }

  const std::uint32_t kDomain = bus::testing::first_test_domain();
  testing::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "r1.yaml";
};

TEST_F(SensorExamination, WithoutAnyDriverSaysWhereItListened) {
  auto process = doctor("0.5");
  EXPECT_EQ(process.wait(), 1) << process.output();
  EXPECT_THAT(process.output(), HasSubstr("no scan on rt/points: is the driver on, with ROS_DOMAIN_ID=" +
                                          std::to_string(kDomain)));
  EXPECT_THAT(process.output(), HasSubstr("publish sensor_msgs/msg/PointCloud2 (topics.points_type)?"));
  for (const char* topic : {"rt/imu", "rt/fix", "rt/wheel_odometry"})
    EXPECT_THAT(process.output(), HasSubstr(std::string("- no sample on ") + topic + ": "));
}

/// A driver that publishes until it is destroyed.
class Driver {
 public:
  using Publish = std::function<void(bus::DdsBus&)>;
  Driver(std::uint32_t domain, const std::vector<bus::Topic>& topics, Publish at_100_hz, Publish at_10_hz) {
    bus::DdsBusConfig config;
    config.agent = *AgentId::parse("driver");
    config.qos_directory = std::filesystem::path(FLEETMAP_SOURCE_DIR) / "qos";
    config.onboard.domain = domain;
    config.long_range.enabled = config.short_range.enabled = false;
    auto made = bus::DdsBus::create(config);
    EXPECT_TRUE(made) << made.error().message;
    if (!made) return;
    bus_ = std::move(*made);
    fast_ = bus_->every(std::chrono::milliseconds(10), {"fast", [=, this] { at_100_hz(*bus_); }});
    slow_ = bus_->every(std::chrono::milliseconds(100), {"slow", [=, this] { at_10_hz(*bus_); }});
    for (const bus::Topic& topic : topics) bus_->advertise(topic);
    thread_ = std::thread([this] { bus_->run_until(stop_); });
  }
  ~Driver() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

 private:
  std::unique_ptr<bus::DdsBus> bus_;
  bus::Handle fast_, slow_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

void publish_imu_in_g(bus::DdsBus& bus) {
  sensor::Imu sample;
  sample.stamp = bus.now();
  sample.specific_force.z() = 1.0;
  bus.publish(ros_codec::topics::imu(), ros_codec::encode(sample));
}

TEST_F(SensorExamination, HearsTheSensorsAndNamesAccelerationInG) {
  const auto publish_scan = [](bus::DdsBus& bus) {
    sensor::Scan scan;
    scan.stamp = bus.now();
    scan.points.push_back({{1.0f, 2.0f, 3.0f}});
    bus.publish(ros_codec::topics::points(), ros_codec::encode(scan));
  };
  const Driver driver(kDomain, {ros_codec::topics::imu(), ros_codec::topics::points()}, publish_imu_in_g,
                      publish_scan);
  auto process = doctor("4");
  EXPECT_EQ(process.wait(), 1) << process.output();
  EXPECT_THAT(process.output(), HasSubstr("its unit is g "));
  EXPECT_THAT(process.output(), HasSubstr("Hz, longest gap"));
  EXPECT_THAT(process.output(), Not(HasSubstr("no scan on")));
}

/// A Livox LiDAR, whose IMU reports g, under the driver's own names.
TEST_F(SensorExamination, HearsTheMessagesOfALivoxDriver) {
  std::ofstream(file_, std::ios::app)
      << "topics: {points: /livox/lidar, points_type: livox_ros_driver2/msg/CustomMsg}\n"
         "lidar: {model: generic}\n";
  const bus::Topic points{bus::Link::kOnboard, "rt/livox/lidar", "livox_ros_driver2::msg::dds_::CustomMsg_",
                          "sensor"};
  const auto publish_points = [points](bus::DdsBus& bus) {
    testing::LivoxMessage message;
    message.stamp = message.timebase = static_cast<std::uint64_t>(to_ns(bus.now()));
    for (std::uint32_t k = 0; k < 100; ++k) message.points.push_back({.offset_time = k * 1'000'000});
    bus.publish(points, message.cdr());
  };
  const Driver driver(kDomain, {ros_codec::topics::imu(), points}, publish_imu_in_g, publish_points);
  auto process = doctor("4");
  EXPECT_EQ(process.wait(), 1) << process.output();
  EXPECT_THAT(process.output(), ContainsRegex("LiDAR +[1-9]"));
  EXPECT_THAT(process.output(), HasSubstr("its unit is g "));
  EXPECT_THAT(process.output(), Not(HasSubstr("no scan on")));
}

TEST_F(SensorExamination, ThatGpsdIsMissingIsSaid) {
  std::ofstream(file_, std::ios::app) << "gps: {gpsd: \"127.0.0.1:1\"}\n";
  auto process = doctor("2");
  EXPECT_EQ(process.wait(), 1) << process.output();
  EXPECT_THAT(process.output(), HasSubstr("- no fix is heard: 127.0.0.1:1: Connection refused; start it, or "
                                          "correct host and port\n"));
  EXPECT_THAT(process.output(), Not(HasSubstr("no sample on rt/fleetmap/doctor/fix")));
}

TEST_F(SensorExamination, ThatGpsdHasNoReceiverIsSaid) {
  const testing::GpsdServer gpsd([] { return std::string("{\"class\":\"SKY\"}\n"); });
  std::ofstream(file_, std::ios::app) << "gps: {gpsd: \"" << gpsd.place() << "\"}\n";
  auto process = doctor("3");
  EXPECT_EQ(process.wait(), 1) << process.output();
  EXPECT_THAT(process.output(), HasSubstr("- no fix is heard: gpsd at " + gpsd.place() +
                                          " sends no position (TPV with a time)"));
}

/// The agent publishes what it hears of gpsd itself; another doctor listens to its topic here.
TEST_F(SensorExamination, FixesOfGpsdAreHeardAndStayAwayFromTheAgentsTopic) {
  const testing::GpsdServer gpsd([] {
    return R"({"class":"TPV","mode":3,"lat":48.2,"lon":11.6,"altHAE":500.0,"time":")" + to_utc(system_now()) +
           "\"}\n";
  });
  const std::filesystem::path topic_file = folder_.path() / "topic.yaml";
  std::filesystem::copy_file(file_, topic_file);
  auto beside = testing::Process({testing::kProgram, "doctor", "-c", topic_file.string(), "--seconds", "8"});
  std::ofstream(file_, std::ios::app) << "gps: {gpsd: \"" << gpsd.place() << "\"}\n";
  auto process = doctor("6");
  EXPECT_EQ(beside.wait(), 1);
  process.wait();
  EXPECT_THAT(process.output(), ContainsRegex("GPS +[1-9]"));
  EXPECT_THAT(process.output(), Not(HasSubstr("no fix is heard")));
  EXPECT_THAT(beside.output(), ContainsRegex("GPS +0 +none"));
}

}  // namespace
}  // namespace fleetmap
