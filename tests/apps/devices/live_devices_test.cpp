// A robot whose sensors have no drivers, from its shipped configuration alone: a LiDAR's packets over UDP, an
// autopilot's messages over a serial port.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <numbers>
#include <thread>

#include "bus/dds_domains.hpp"
#include "fleetmap/store/store.hpp"
#include "support/command_line.hpp"
#include "support/eventually.hpp"
#include "support/mavlink_packets.hpp"
#include "support/ouster_packets.hpp"
#include "support/process.hpp"
#include "support/pseudo_terminal.hpp"
#include "support/temporary_folder.hpp"
#include "support/udp_sender.hpp"
#include "support/velodyne_packets.hpp"

namespace fleetmap {
namespace {

using namespace fleetmap::testing;
using namespace std::chrono_literals;
using Eigen::Vector3d;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::chrono::seconds kMadeWithin(240);
/// The robot stands with its front to the east where gps_raw_int() says that the antenna is.
const GeoPoint kAntenna = geo_point_from_degrees(39.0, -3.0, 650.0);
const Vector3d kAntennaInBase(-0.15, 0.0, 0.40);  // of config/robots/jackal_vlp16.yaml

using Clock = std::chrono::steady_clock;

Duration since(Clock::time_point begin) { return std::chrono::duration_cast<Duration>(Clock::now() - begin); }

/// Calls `step` with the time since its begin, every so often, until it ends.
class Ticker {
 public:
  Ticker(Clock::duration period, std::function<void(Duration)> step)
      : thread_([period, step = std::move(step)](const std::stop_token& stop) {
          const auto begun = Clock::now();
          for (auto next = begun; !stop.stop_requested(); next += period) {
            std::this_thread::sleep_until(next);
            step(since(begun));
          }
        }) {}

 private:
  std::jthread thread_;
};

/// A Pixhawk that was switched on 100 s ago: IMU and attitude at 50 Hz, GPS at 5 Hz, its time at 1 Hz.
class Autopilot {
 public:
  const std::string& path() const { return line_.path(); }
  int answered() const { return answered_; }

 private:
  static std::uint64_t microseconds(Duration time) { return static_cast<std::uint64_t>(time / 1us); }
  void step(Duration time) {
    const Duration boot = 100s + time;
    const auto ms = static_cast<std::uint32_t>(boot / 1ms);
    const Eigen::Quaterniond east(Eigen::AngleAxisd(std::numbers::pi / 2.0, Vector3d::UnitZ()));
    line_.send(attitude_quaternion(ms, east));
    line_.send(highres_imu(microseconds(boot), {0.0, 0.0, -9.81}, Vector3d::Zero()));
    if (steps_ % 10 == 0) line_.send(gps_raw_int(microseconds(boot - 120ms), 3));
    if (steps_ % 50 == 0) line_.send(system_time(0, ms));
    ++steps_;
    for (const sensor::MavlinkFrame& frame : requests_.add(line_.receive())) {
      const auto request = sensor::decode_mavlink(frame);
      if (!request || !std::holds_alternative<sensor::MavlinkTimesync>(*request)) continue;
      line_.send(sensor::encode_mavlink({boot, std::get<sensor::MavlinkTimesync>(*request).asked}, 0));
      ++answered_;
    }
  }

  PseudoTerminal line_;
  sensor::MavlinkFrames requests_;
  std::uint64_t steps_ = 0;
  std::atomic<int> answered_ = 0;
  Ticker ticker_{20ms, [this](Duration time) { step(time); }};
};

/// A VLP-16 in a hall of 14 m by 10 m, 1.2 m above its floor and 4 m below its ceiling.
class Lidar {
 public:
  explicit Lidar(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    to_.sin_family = AF_INET;
    to_.sin_port = htons(port);
    to_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    device_.range_at = [](double azimuth, double elevation) {
      const double wall = std::min(7.0 / std::abs(std::cos(azimuth)), 5.0 / std::abs(std::sin(azimuth)));
      const double level =
          elevation < 0.0 ? 1.2 / std::sin(-elevation) : 4.0 / std::sin(std::max(elevation, 1e-3));
      return std::min(wall / std::cos(elevation), level);
    };
    ticker_.emplace(10ms, [this](Duration time) { step(time); });
  }
  ~Lidar() {
    ticker_.reset();
    ::close(socket_);
  }

 private:
  void step(Duration time) {
    while (next_.fired < time + 1000s) {
      ::sendto(socket_, next_.bytes.data(), next_.bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to_),
               sizeof to_);
      next_ = device_.next();
    }
  }

  int socket_;
  sockaddr_in to_{};
  VelodyneDevice device_{1000s};
  VelodyneDevice::Packet next_ = device_.next();
  std::optional<Ticker> ticker_;
};

TEST(LiveDevices, TheJackalMakesAGeoreferencedNode) {
  const TemporaryFolder folder;
  const Autopilot autopilot;
  const std::uint16_t port = testing::free_udp_port();
  const std::uint32_t domain = bus::testing::first_test_domain();
  std::vector<std::string> command{testing::kProgram, "agent", "-c",
                                   FLEETMAP_SOURCE_DIR "/config/robots/jackal_vlp16.yaml"};
  for (const std::string& set :
       {"directory=" + folder.path().string(), "mavlink.device=" + autopilot.path(),
        "lidar.velodyne_port=" + std::to_string(port), "dds.onboard.domain=" + std::to_string(domain),
        "dds.long_range.domain=" + std::to_string(domain + 1),
        "dds.short_range.domain=" + std::to_string(domain + 2)})
    command.insert(command.end(), {"--set", set});
  Process agent(command);
  ASSERT_TRUE(eventually([&] { return autopilot.answered() > 0 || !agent.running(); }, kMadeWithin))
      << agent.output();
  const Lidar lidar(port);
  std::optional<graph::Node> node;
  const auto made = [&] {
    const auto store = store::Store::open_read_only(folder.path() / "store.db");
    if (store && !store->nodes().empty()) node = store->nodes().begin()->second;
    return node.has_value() || !agent.running();
  };
  ASSERT_TRUE(eventually(made, kMadeWithin)) << agent.output();
  agent.signal(SIGINT);
  EXPECT_EQ(agent.wait(), 0) << agent.output();

  ASSERT_TRUE(node && node->G) << agent.output();
  const Vector3d forward = node->G->q_enu_base * Vector3d::UnitX();
  EXPECT_GT(forward.x(), std::cos(0.02)) << "east; " << forward.transpose();
  const Vector3d antenna =
      LocalFrame(kAntenna).to_enu(node->G->position) + node->G->q_enu_base * kAntennaInBase;
  EXPECT_LT(antenna.norm(), 0.05) << antenna.transpose();
  EXPECT_LT(std::abs(to_seconds(std::chrono::system_clock::now() - node->stamp)), 120.0);
  EXPECT_GT(node->submap_bytes, 1000u);
  EXPECT_THAT(agent.output(), Not(HasSubstr("wrong checksum")));
  EXPECT_THAT(agent.output(), Not(HasSubstr("refused")));
}

/// An OS1 that was switched on 1000 s ago, in a round room, with its IMU at 100 Hz.
class Ouster {
 public:
  Ouster(std::uint16_t lidar_port, std::uint16_t imu_port) : lidar_(lidar_port), imu_(imu_port) {}

 private:
  void step(Duration time) {
    for (; next_.sent < time + 1000s; next_ = device_.next()) lidar_.send(next_.bytes);
    imu_.send(OusterDevice::imu(time + 1000s, {0.0f, 0.0f, 1.0f}, {0.0f, 0.0f, 0.0f}));
  }

  UdpSender lidar_, imu_;
  OusterDevice device_{1000s};
  OusterDevice::Packet next_ = device_.next();
  Ticker ticker_{10ms, [this](Duration time) { step(time); }};
};

TEST(LiveDevices, TheDoctorHearsAnOusterLidarAndItsImu) {
  const TemporaryFolder folder;
  folder.write("os.json", OusterDevice(Duration::zero()).metadata());
  const std::uint16_t port = free_udp_port(), imu_port = free_udp_port();
  const std::uint32_t domain = bus::testing::first_test_domain();
  std::vector<std::string> command{
      testing::kProgram, "doctor", "-c", FLEETMAP_SOURCE_DIR "/config/robots/rover_ouster.yaml",
      "--seconds",       "5"};
  for (const std::string& set :
       {"directory=" + folder.path().string(),
        "lidar.ouster_metadata=" + (folder.path() / "os.json").string(),
        "lidar.ouster_port=" + std::to_string(port), "lidar.ouster_imu_port=" + std::to_string(imu_port),
        "dds.onboard.domain=" + std::to_string(domain), "dds.long_range.domain=" + std::to_string(domain + 1),
        "dds.short_range.domain=" + std::to_string(domain + 2)})
    command.insert(command.end(), {"--set", set});
  const Ouster ouster(port, imu_port);
  Process doctor(command);
  doctor.wait();
  EXPECT_THAT(doctor.output(), HasSubstr("receives OS-1-16 122 for rt/points"));
  EXPECT_THAT(doctor.output(), ContainsRegex("LiDAR +[1-9]"));
  EXPECT_THAT(doctor.output(), ContainsRegex("IMU +[1-9][0-9][0-9]"));
  EXPECT_THAT(doctor.output(), Not(HasSubstr("its unit is"))) << "m/s^2 and rad/s";
  // No gpsd runs here, which refuses the connection.
  EXPECT_THAT(doctor.output(), Not(ContainsRegex("(packets|samples|scans|LiDAR|IMU)[^\n]*refused")));
}

}  // namespace
}  // namespace fleetmap
