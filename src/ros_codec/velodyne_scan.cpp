#include "fleetmap/ros_codec/velodyne_scan.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "fleetmap/bus/cdr.hpp"
#include "ros_time.hpp"
#include "type_names.hpp"
#include "velodyne_msgs.h"

namespace fleetmap::ros_codec {
namespace {

using velodyne_msgs::msg::dds_::VelodynePacket_;
using velodyne_msgs::msg::dds_::VelodyneScan_;

constexpr std::size_t kPacketBytes = 1206;

/// Refuses more packets than the bytes can hold before they are allocated.
void peek_count(eprosima::fastcdr::Cdr& cdr, std::size_t bytes) {
  std_msgs::msg::dds_::Header_ header;
  std::uint32_t packets = 0;
  header.deserialize(cdr);
  cdr >> packets;
  if (packets > bytes / kPacketBytes)
    throw std::length_error("too few for " + std::to_string(packets) + " packets");
}

}  // namespace

Bytes encode(const VelodyneScan& scan, std::string_view frame_id) {
  VelodyneScan_ out;
  out.header().stamp(to_ros(scan.stamp));
  out.header().frame_id(std::string(frame_id));
  for (const VelodyneScan::Packet& packet : scan.packets) {
    VelodynePacket_ one;
    one.stamp(to_ros(packet.received));
    std::copy_n(packet.data.begin(), std::min(packet.data.size(), one.data().size()), one.data().begin());
    out.packets().push_back(one);
  }
  return bus::to_cdr(out);
}

Result<VelodyneScan> decode_velodyne_scan(ByteView cdr) {
  const auto in = bus::from_cdr<VelodyneScan_>(cdr, type_name::kVelodyneScan,
                                               [&](auto& stream) { peek_count(stream, cdr.size()); });
  if (!in) return tl::unexpected(in.error());
  const auto stamp = from_ros(in->header().stamp(), type_name::kVelodyneScan);
  if (!stamp) return tl::unexpected(stamp.error());
  VelodyneScan scan;
  scan.stamp = *stamp;
  for (const VelodynePacket_& packet : in->packets()) {
    const auto received = from_ros(packet.stamp(), type_name::kVelodyneScan);
    scan.packets.push_back(
        {received ? *received : Stamp(), Bytes(packet.data().begin(), packet.data().end())});
  }
  return scan;
}

}  // namespace fleetmap::ros_codec
