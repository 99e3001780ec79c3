#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>

namespace fleetmap::agent {

inline constexpr std::array<std::uint32_t, 10> kBaudRates = {4800,   9600,   19200,  38400,  57600,
                                                             115200, 230400, 460800, 921600, 1000000};

/// A serial port of this machine, to which a sensor is connected.
struct SerialPort {
  std::filesystem::path path;
  std::uint32_t baud = 0;  ///< one of kBaudRates; USB devices take any
};
/// A port of this machine, to which the device sends.
struct UdpPort {
  std::uint16_t port = 0;
};
/// A TCP server that sends a sensor's data, such as gpsd.
struct TcpServer {
  std::string host;
  std::uint16_t port = 0;
};
using DevicePlace = std::variant<SerialPort, UdpPort, TcpServer>;

/// As a log names it: "/dev/ttyACM0", "UDP port 14550", "localhost:2947".
std::string to_string(const DevicePlace& place);

/// Sensors that have no driver: the program reads them itself and publishes them on topics.imu and
/// topics.fix. Perception hears the topics either way.
struct DeviceConfig {
  std::optional<SerialPort> nmea;      ///< a GPS receiver that sends NMEA 0183
  std::optional<TcpServer> gpsd;       ///< gpsd
  std::optional<DevicePlace> mavlink;  ///< an autopilot, at a serial or a UDP port
  bool mavlink_gps = true;             ///< its fixes are used
  bool mavlink_imu = true;             ///< its IMU is used
  std::optional<std::string> geoid;    ///< name of that which fixes above sea level are above
};

}  // namespace fleetmap::agent
