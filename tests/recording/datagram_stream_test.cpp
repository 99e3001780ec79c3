#include "datagram_stream.hpp"

#include <gtest/gtest.h>

namespace fleetmap::recording {
namespace {

TEST(DatagramStream, IsTheSourceAndTheDestinationsPort) {
  const Datagram datagram{.captured = {}, .source = 0xc0a801c9, .port = 2368, .payload = {}};
  EXPECT_EQ(stream_of(datagram), (DatagramStream{0xc0a801c9, 2368}));
  EXPECT_EQ(to_string(stream_of(datagram)), "192.168.1.201 to port 2368");
}

}  // namespace
}  // namespace fleetmap::recording
