#include "sensor_sections.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "fleetmap/core/text_list.hpp"
#include "fleetmap/ros_codec/points_type.hpp"

namespace fleetmap::config {
namespace {

std::uint16_t read_port(Section& section, const std::string& key, const char* usual) {
  std::uint32_t port = 0;
  section.read(key, port);
  if (port < 1 || port > 65535) section.problem(key, std::string("expected a UDP port, usually ") + usual);
  return static_cast<std::uint16_t>(port);
}

bool states_mount(Section& sensor) { return sensor.has("translation") || sensor.has("rotation_rpy_deg"); }

void read_ouster(Section& lidar, agent::PerceptionConfig& perception) {
  agent::OusterConfig& ouster = perception.ouster;
  std::filesystem::path file;
  lidar.read_path("ouster_metadata", file);
  if (!file.empty()) {
    if (auto metadata = sensor::load_ouster_metadata(file)) {
      ouster.metadata = std::move(*metadata);
    } else {
      lidar.problem(
          "ouster_metadata",
          metadata.error().message + "; expected what `curl http://SENSOR/api/v1/sensor/metadata` writes");
    }
  }
  if (lidar.has("ouster_port")) ouster.lidar_port = read_port(lidar, "ouster_port", "7502");
  if (lidar.has("ouster_imu_port")) ouster.imu_port = read_port(lidar, "ouster_imu_port", "7503");
  if (ouster.lidar_port != 0 && !lidar.has("ouster_metadata"))
    lidar.problem("ouster_port",
                  "expected lidar.ouster_metadata as well: a file that "
                  "`curl http://SENSOR/api/v1/sensor/metadata` writes");
  if (ouster.lidar_port != 0 && perception.velodyne_port != 0)
    lidar.problem("ouster_port", "lidar.velodyne_port is given as well; expected one of them");
  if (ouster.imu_port == 0) return;
  if (ouster.lidar_port == 0) lidar.problem("ouster_imu_port", "expected lidar.ouster_port as well");
  if (ouster.lidar_port == ouster.imu_port)
    lidar.problem("ouster_imu_port", "expected another port than lidar.ouster_port");
  if (ouster.metadata && !ouster.metadata->has_imu_packets)
    lidar.problem("ouster_imu_port",
                  "the sensor's udp_profile_imu is not LEGACY; set it so, and store the metadata "
                  "again");
}

void read_lidar(Section& top, agent::PerceptionConfig& perception) {
  Section lidar = top.section("lidar");
  std::string model = perception.lidar.name;
  lidar.read("model", model);
  if (const auto known = odometry::lidar_model(model)) {
    perception.lidar = *known;
  } else {
    lidar.problem("model", known.error().message);
  }
  lidar.read_mount(perception.odometry.T_base_lidar);
  perception.mount_configured[static_cast<std::size_t>(sensor::Source::kLidar)] = states_mount(lidar);
  lidar.read("max_range", perception.odometry.max_range);
  lidar.read("min_range", perception.odometry.min_range);
  lidar.read("range_noise", perception.odometry.range_noise);
  lidar.read("scan_period", perception.lidar.scan_period);
  lidar.read_degrees("elevations_deg", perception.lidar.vertical_angles);
  if (lidar.has("velodyne_port")) perception.velodyne_port = read_port(lidar, "velodyne_port", "2368");
  read_ouster(lidar, perception);
  lidar.finish();
}

/// ROS 2's "/points" is "rt/points" on the wire.
void read_topics(Section& top, agent::SensorTopics& topics) {
  Section section = top.section("topics");
  for (const auto& [key, name] : {std::pair<const char*, std::string*>{"points", &topics.points},
                                  {"imu", &topics.imu},
                                  {"fix", &topics.fix},
                                  {"wheel", &topics.wheel}}) {
    section.read(key, *name);
    if (name->starts_with("/")) *name = "rt" + *name;
    if (name->empty()) section.problem(key, "expected the name of a topic, e.g. /velodyne_points");
  }
  std::string points_type(ros_codec::ros_name(topics.points_type));
  section.read("points_type", points_type);
  if (const auto known = ros_codec::points_type(points_type)) {
    topics.points_type = *known;
  } else {
    section.problem("points_type", known.error().message);
  }
  section.finish();
}

void read_odometry(Section& top, agent::PerceptionConfig& perception) {
  odometry::LoamConfig& loam = perception.odometry;
  Section section = top.section("odometry");
  section.read("use_imu", perception.odometry_uses_imu);
  section.read("use_wheel", perception.odometry_uses_wheel);
  section.read("deskew", loam.deskew);
  section.read("match_spacing", loam.match_spacing);
  section.read("insert_spacing", loam.insert_spacing);
  // A map that reaches less far than the scans would leave their far points unmatched.
  loam.map_radius = std::max(loam.map_radius, loam.max_range);
  section.read("map_radius", loam.map_radius);
  section.read("max_map_windows", loam.max_map_windows);
  section.read("fine_resolution", loam.fine_resolution);
  section.read("coarse_resolution", loam.coarse_resolution);
  section.read("max_iterations", loam.max_iterations);
  section.read("initial_speed", loam.initial_speed);
  section.read("linear_acceleration", loam.linear_acceleration);
  section.read("angular_acceleration", loam.angular_acceleration);
  section.read("gyro_noise", loam.gyro_noise);
  section.read("wheel_speed_noise", loam.wheel_speed_noise);
  std::uint32_t waiting = static_cast<std::uint32_t>(perception.waiting_scans);
  section.read("waiting_scans", waiting);
  perception.waiting_scans = waiting;
  section.finish();
  const Status valid = loam.validate();
  if (valid) return;
  Section lidar = top.section("lidar");  // holds some of the odometry's settings
  (lidar.names(valid.error().message) ? lidar : section).check(valid);
}

void read_imu(Section& top, agent::PerceptionConfig& perception) {
  localization::EkfConfig& ekf = perception.localization;
  Section imu = top.section("imu");
  imu.read_mount(ekf.mounting.T_base_imu);
  perception.mount_configured[static_cast<std::size_t>(sensor::Source::kImu)] = states_mount(imu);
  perception.odometry.q_base_imu = Eigen::Quaterniond(ekf.mounting.T_base_imu.linear());
  imu.read("gyro_noise", ekf.imu.gyro_noise);
  imu.read("accel_noise", ekf.imu.accel_noise);
  imu.read("gyro_bias_sigma", ekf.imu.gyro_bias_sigma);
  imu.read("accel_bias_sigma", ekf.imu.accel_bias_sigma);
  imu.read("gyro_bias_walk", ekf.imu.gyro_bias_walk);
  imu.read("accel_bias_walk", ekf.imu.accel_bias_walk);
  imu.read("max_gap", ekf.imu.max_gap);
  imu.read("use_orientation", ekf.imu.use_orientation);
  imu.finish();
}

/// The serial port whose path is at `path_key`; empty where it is not given.
std::optional<agent::SerialPort> read_serial(Section& section, const std::string& path_key,
                                             const std::string& baud_key, std::uint32_t usual_baud) {
  agent::SerialPort serial{.path = {}, .baud = usual_baud};
  section.read_path(path_key, serial.path);
  section.read(baud_key, serial.baud);
  if (std::ranges::find(agent::kBaudRates, serial.baud) == agent::kBaudRates.end()) {
    std::string known;
    for (const std::uint32_t baud : agent::kBaudRates) append_to_list(known, std::to_string(baud));
    section.problem(baud_key, "expected one of " + known);
  }
  if (section.has(baud_key) && !section.has(path_key))
    section.problem(baud_key, "is of no use without " + path_key);
  if (!section.has(path_key)) return std::nullopt;
  if (serial.path.empty()) section.problem(path_key, "expected a device, e.g. /dev/ttyUSB0");
  return serial;
}

std::optional<agent::TcpServer> read_gpsd(Section& gps) {
  if (!gps.has("gpsd")) return std::nullopt;
  std::string text;
  gps.read("gpsd", text);
  agent::TcpServer server{.host = text.substr(0, text.rfind(':')), .port = 2947};
  if (const auto colon = text.rfind(':'); colon != std::string::npos) {
    const char* end = text.data() + text.size();
    const auto read = std::from_chars(text.data() + colon + 1, end, server.port);
    if (read.ec != std::errc{} || read.ptr != end) server.port = 0;
  }
  if (server.host.empty() || server.port == 0)
    gps.problem("gpsd", "expected HOST or HOST:PORT, e.g. localhost");
  return server;
}

void read_mavlink(Section& top, bool lidar_has_imu, agent::DeviceConfig& devices) {
  Section mavlink = top.section("mavlink");
  if (const auto serial = read_serial(mavlink, "device", "baud", 57600)) devices.mavlink = *serial;
  if (mavlink.has("udp_port")) {
    if (devices.mavlink) mavlink.problem("udp_port", "mavlink.device is given as well; expected one of them");
    devices.mavlink = agent::UdpPort{read_port(mavlink, "udp_port", "14550")};
  }
  mavlink.read("gps", devices.mavlink_gps);
  mavlink.read("imu", devices.mavlink_imu);
  if (devices.mavlink && !devices.mavlink_gps && !devices.mavlink_imu)
    mavlink.problem("imu", "neither gps nor imu of the autopilot is used; expected one of them to be true");
  if (devices.mavlink && devices.mavlink_imu && lidar_has_imu)
    mavlink.problem(
        "imu",
        "the LiDAR's IMU is used as well (lidar.ouster_imu_port); expected false, or that port left "
        "out");
  mavlink.finish();
}

void read_geoid(Section& gps, agent::DeviceConfig& devices) {
  if (!gps.has("geoid")) return;
  std::string name;
  gps.read("geoid", name);
  if (!devices.nmea && !devices.gpsd && !(devices.mavlink && devices.mavlink_gps)) {
    gps.problem("geoid",
                "is of use with gps.nmea_device, gps.gpsd or mavlink alone: fixes of a driver are above the "
                "ellipsoid by their definition (NavSatFix)");
    return;
  }
  devices.geoid = name;
}

void read_gps(Section& top, agent::PerceptionConfig& perception) {
  localization::EkfConfig& ekf = perception.localization;
  agent::DeviceConfig& devices = perception.devices;
  Section gps = top.section("gps");
  devices.nmea = read_serial(gps, "nmea_device", "nmea_baud", 9600);
  devices.gpsd = read_gpsd(gps);
  if (devices.nmea && devices.gpsd) gps.problem("gpsd", "nmea_device is given as well; expected one of them");
  if ((devices.nmea || devices.gpsd) && devices.mavlink && devices.mavlink_gps)
    gps.problem(devices.nmea ? "nmea_device" : "gpsd",
                "the autopilot's GPS is used as well; set mavlink.gps: false, or leave this one out");
  gps.read("use", perception.uses_gps);
  if (!perception.uses_gps && (devices.nmea || devices.gpsd))
    gps.problem("use", "a receiver is given as well; leave one of them out");
  if (!perception.uses_gps && devices.mavlink && devices.mavlink_gps)
    gps.problem("use", "the autopilot's GPS is used; set mavlink.gps: false as well");
  read_geoid(gps, devices);
  gps.read_lever_arm("translation", ekf.mounting.p_base_antenna);
  perception.mount_configured[static_cast<std::size_t>(sensor::Source::kGps)] = gps.has("translation");
  gps.read("correlation_time", ekf.gps.correlation_time);
  gps.read("correlated_share", ekf.gps.correlated_share);
  gps.read("default_sigma_h", ekf.gps.default_sigma_h);
  gps.read("default_sigma_v", ekf.gps.default_sigma_v);
  gps.read("sigma_floor", ekf.gps.sigma_floor);
  gps.read("max_speed", ekf.gps.max_speed);
  gps.read("max_site_radius", ekf.gps.max_site_radius);
  gps.finish();
}

void read_wheel(Section& top, localization::EkfConfig& ekf) {
  Section wheel = top.section("wheel");
  wheel.read("speed_sigma", ekf.wheel.speed_sigma);
  wheel.read("speed_scale", ekf.wheel.speed_scale);
  wheel.read("yaw_rate_sigma", ekf.wheel.yaw_rate_sigma);
  wheel.read("lateral_sigma", ekf.wheel.lateral_sigma);
  wheel.read("vertical_sigma", ekf.wheel.vertical_sigma);
  wheel.read("turn_offset", ekf.wheel.turn_offset);
  wheel.finish();
}

}  // namespace

void read_perception(Section& top, agent::PerceptionConfig& perception) {
  read_topics(top, perception.topics);
  read_lidar(top, perception);
  read_imu(top, perception);
  read_mavlink(top, perception.ouster.imu_port != 0, perception.devices);
  read_gps(top, perception);
  read_wheel(top, perception.localization);
  read_odometry(top, perception);
  top.check(perception.lidar.validate());
  top.check(perception.localization.validate());
}

}  // namespace fleetmap::config
