#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/ros_codec/decode.hpp"
#include "fleetmap/sensor/scan.hpp"

namespace fleetmap::ros_codec {

/// The unit of a scan's point times. The field's type defines it: integers are ns, floats s.
enum class TimeUnit : std::uint8_t {
  kAsDefined,
  kMicroseconds,  ///< a sweep takes 5 ms to 1 s in this unit alone; converted, like the next two
  kMilliseconds,
  kNanoseconds,
  kUnclear  ///< of floats: a sweep in none; the scan has no point times
};
/// The finding, with its remedy; empty for kAsDefined.
std::string finding_of(TimeUnit unit);

/// A decoded message of points and what was left out of it.
struct DecodedScan {
  sensor::Scan scan;
  std::size_t non_finite_points = 0;  ///< dropped: NaN or infinite coordinate
  std::size_t origin_points = 0;      ///< dropped: exactly (0, 0, 0), the mark of "no return"
  std::size_t noise_points = 0;       ///< dropped: the device marks them as noise
  /// Point times were absolute in a clock more than 10 s away from the header's; they were counted from the
  /// earliest point instead.
  bool foreign_clock = false;
  TimeUnit time_unit = TimeUnit::kAsDefined;
};

/// PointCloud2 with x, y, z, intensity (float32), ring (uint16) if there, time (float32, s after the stamp)
/// if there.
Bytes encode(const sensor::Scan& scan, std::string_view frame_id = "lidar");
/// Reads a PointCloud2 of any driver: x, y, z float32 or float64 needed, in any order and at any offset;
/// optional `intensity` of any numeric type; `ring` or `channel` (uint8, uint16, uint32); point time in
/// `time`, `t`, `timestamp`, `offset_time` or `time_stamp` (float: s, or ns if beyond 1e12, or the unit in
/// which alone they are a sweep after the stamp or on its day; integer: ns, or us if the sweep would take
/// less than 1 ms), relative to the header's stamp or absolute. Refuses data that contradict height, width,
/// point_step and row_step.
Result<DecodedScan> decode_scan(ByteView cdr);

template <>
Result<sensor::Scan> decode(ByteView cdr);

}  // namespace fleetmap::ros_codec
