#pragma once

#include <string_view>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"

namespace fleetmap::ros_codec {

/// Packets of a Velodyne LiDAR as a ROS driver recorded them: velodyne_msgs/msg/VelodyneScan. Not decoded;
/// sensor::VelodyneSweeps does that.
struct VelodyneScan {
  struct Packet {
    Stamp received;  ///< by the driver; at the epoch if it was not filled in
    Bytes data;      ///< 1206 bytes
  };
  Stamp stamp;  ///< of the header
  std::vector<Packet> packets;
};

/// Packets of another size are cut or filled with zeros.
Bytes encode(const VelodyneScan& scan, std::string_view frame_id = "velodyne");
/// Errors name the type and the reason. Stamps of packets that are no time count as not filled in.
Result<VelodyneScan> decode_velodyne_scan(ByteView cdr);

}  // namespace fleetmap::ros_codec
