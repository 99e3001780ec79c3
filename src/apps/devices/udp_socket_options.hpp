#pragma once

namespace fleetmap::apps {

struct UdpSocketOptions {
  int receive_buffer = 0;        ///< B, up to net.core.rmem_max; 0: the system's usual size
  bool stamps_arrivals = false;  ///< each datagram comes with the time at which the kernel received it
};

}  // namespace fleetmap::apps
