#pragma once

#include <string_view>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/sensor/scan.hpp"

namespace fleetmap::ros_codec {

/// A CustomMsg of Livox's drivers: ring from `line`, time from `offset_time` (ns, to 1 ns), tags 0. The stamp
/// is that of the header and the timebase. Points from before the stamp are at the stamp.
Bytes encode_livox(const sensor::Scan& scan, std::string_view frame_id = "lidar");

/// Leaves out points without a return and those whose tag marks them as noise. By the manuals of Mid-70,
/// Horizon, Avia and HAP the bits 0 and 1 are noise by position (1 for certain, 2 likely, 3 hardly), 2 and 3
/// by intensity (1 likely, 2 perhaps: dust, rain and fog), 6 and 7 a distorted waveform (1); those of the
/// Mid-360 grade a point's confidence in the same places (0 high, 1 moderate, 2 low). Points at 1 or 2 are
/// left out, those of all returns (bits 4 and 5) are used.
///
/// Times count from the header's stamp by the timebase; if that is of another clock, offsets count from the
/// stamp (DecodedScan::foreign_clock; a timebase of 0 is none). Errors name the reason.
Result<DecodedScan> decode_livox(ByteView cdr);

}  // namespace fleetmap::ros_codec
