#pragma once

#include <string>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/sensor/frame_tree.hpp"

namespace fleetmap::ros_codec {

/// A tf2_msgs/TFMessage, stamped 0.
Bytes encode(const std::vector<sensor::FrameTransform>& transforms);
/// Values are as they came; sensor::FrameTree checks them.
Result<std::vector<sensor::FrameTransform>> decode_transforms(ByteView cdr);

/// The frame_id of any message that begins with a header, without reading the rest.
Result<std::string> frame_id_of(ByteView cdr);

}  // namespace fleetmap::ros_codec
