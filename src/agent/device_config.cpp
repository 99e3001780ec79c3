#include "fleetmap/agent/device_config.hpp"

namespace fleetmap::agent {
namespace {

struct Name {
  std::string operator()(const SerialPort& serial) const { return serial.path.string(); }
  std::string operator()(const UdpPort& udp) const { return "UDP port " + std::to_string(udp.port); }
  std::string operator()(const TcpServer& server) const {
    return server.host + ":" + std::to_string(server.port);
  }
};

}  // namespace

std::string to_string(const DevicePlace& place) { return std::visit(Name{}, place); }

}  // namespace fleetmap::agent
