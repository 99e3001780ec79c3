// `fleetmap doctor` beside drivers: it hears what an agent would, and names what is wrong.
#include <gmock/gmock.h>

#include <fstream>
#include <string>
#include <thread>

#include "bus/dds_domains.hpp"
#include "fleetmap/bus/dds_bus.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "support/command_line.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class Doctor : public ::testing::Test {
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

TEST_F(Doctor, WithoutAnyDriverSaysWhereItListened) {
  auto process = doctor("0.5");
  EXPECT_EQ(process.wait(), 1) << process.output();
  EXPECT_THAT(process.output(), HasSubstr("no scan on rt/points: is the driver on, with ROS_DOMAIN_ID=" +
                                          std::to_string(kDomain)));
}

TEST_F(Doctor, HearsTheSensorsAndNamesAccelerationInG) {
  bus::DdsBusConfig config;
  config.agent = *AgentId::parse("driver");
  config.qos_directory = std::filesystem::path(FLEETMAP_SOURCE_DIR) / "qos";
  config.onboard.domain = kDomain;
  config.long_range.enabled = config.short_range.enabled = false;
  const auto driver = bus::DdsBus::create(config);
  ASSERT_TRUE(driver) << driver.error().message;
  const auto now = [&] { return (*driver)->now(); };
  const bus::Handle imu =
      (*driver)->every(std::chrono::milliseconds(10), {"imu", [&] {
                                                         sensor::Imu sample;
                                                         sample.stamp = now();
                                                         sample.specific_force.z() = 1.0;
                                                         (*driver)->publish(ros_codec::topics::imu(),
                                                                            ros_codec::encode(sample));
                                                       }});
  const bus::Handle scans =
      (*driver)->every(std::chrono::milliseconds(100), {"scan", [&] {
                                                          sensor::Scan scan;
                                                          scan.stamp = now();
                                                          scan.points.push_back({{1.0f, 2.0f, 3.0f}});
                                                          (*driver)->publish(ros_codec::topics::points(),
                                                                             ros_codec::encode(scan));
                                                        }});
  (*driver)->advertise(ros_codec::topics::imu());
  (*driver)->advertise(ros_codec::topics::points());
  std::atomic<bool> stop = false;
  std::thread publishing([&] { (*driver)->run_until(stop); });
  auto process = doctor("4");
  EXPECT_EQ(process.wait(), 1) << process.output();
  stop = true;
  publishing.join();
  EXPECT_THAT(process.output(), HasSubstr("its unit is g "));
  EXPECT_THAT(process.output(), HasSubstr("Hz, longest gap"));
  EXPECT_THAT(process.output(), Not(HasSubstr("no scan on")));
}

}  // namespace
}  // namespace fleetmap
