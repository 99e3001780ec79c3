#include "fleetmap/agent/device_config.hpp"

#include <gtest/gtest.h>

namespace fleetmap::agent {
namespace {

TEST(DeviceConfig, PlacesAreNamedAsALogReadsThem) {
  EXPECT_EQ(to_string(SerialPort{"/dev/ttyACM0", 57600}), "/dev/ttyACM0");
  EXPECT_EQ(to_string(UdpPort{14550}), "UDP port 14550");
  EXPECT_EQ(to_string(TcpServer{"localhost", 2947}), "localhost:2947");
}

}  // namespace
}  // namespace fleetmap::agent
