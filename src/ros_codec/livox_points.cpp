#include "fleetmap/ros_codec/livox_points.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "fleetmap/bus/cdr.hpp"
#include "livox_msgs.h"
#include "ros_time.hpp"
#include "type_names.hpp"

namespace fleetmap::ros_codec {
namespace {

using livox_ros_driver2::msg::dds_::CustomMsg_;
using livox_ros_driver2::msg::dds_::CustomPoint_;

constexpr std::size_t kLivoxPointBytes = 19;  // the least of one in a message
/// A timebase or a point further from the stamp is not of the same clock or scan.
constexpr Duration kMaxFromStamp = std::chrono::seconds(10);

/// Refuses more points than the bytes can hold before they are allocated.
void peek_points(eprosima::fastcdr::Cdr& cdr, std::size_t bytes) {
  std_msgs::msg::dds_::Header_ header;
  std::uint64_t timebase = 0;
  std::uint32_t point_num = 0, reserved = 0, points = 0;  // lidar_id and rsvd are four bytes in a row
  header.deserialize(cdr);
  cdr >> timebase >> point_num >> reserved >> points;
  if (points > bytes / kLivoxPointBytes)
    throw std::length_error("too few for " + std::to_string(points) + " points");
}

bool is_noise(std::uint8_t tag) {
  const auto graded = [tag](int shift) { return (tag >> shift & 3) == 1 || (tag >> shift & 3) == 2; };
  constexpr int kPosition = 0, kIntensity = 2, kDistortion = 6;
  return graded(kPosition) || graded(kIntensity) || (tag >> kDistortion & 3) == 1;
}

/// From the header's stamp to the timebase.
Duration timebase_after_stamp(const CustomMsg_& in, DecodedScan& out) {
  constexpr std::uint64_t kLatest = 1ull << 62;  // ns; differences of times below do not overflow
  if (in.timebase() == 0) return Duration::zero();
  if (in.timebase() < kLatest) {
    const Duration after = stamp_from_ns(static_cast<std::int64_t>(in.timebase())) - out.scan.stamp;
    if (after >= -kMaxFromStamp && after <= kMaxFromStamp) return after;
  }
  out.foreign_clock = true;
  return Duration::zero();
}

void add_point(const CustomPoint_& in, Duration begin, DecodedScan& out) {
  sensor::ScanPoint point;
  point.position = {in.x(), in.y(), in.z()};
  if (!point.position.allFinite()) return void(++out.non_finite_points);
  if (point.position.isZero(0.0f)) return void(++out.origin_points);
  if (is_noise(in.tag())) return void(++out.noise_points);
  point.intensity = in.reflectivity();
  point.ring = in.line();
  point.time = static_cast<float>(to_seconds(begin + Duration(in.offset_time())));
  out.scan.points.push_back(point);
}

/// A driver that leaves all at a constant states no times.
bool has_livox_times(const CustomMsg_& in) {
  if (in.points().size() < 2) return true;
  const auto [first, last] = std::ranges::minmax_element(
      in.points(), {}, [](const CustomPoint_& point) { return point.offset_time(); });
  return first->offset_time() != last->offset_time();
}

}  // namespace

Bytes encode_livox(const sensor::Scan& scan, std::string_view frame_id) {
  CustomMsg_ out;
  out.header().stamp(to_ros(scan.stamp));
  out.header().frame_id(std::string(frame_id));
  out.timebase(static_cast<std::uint64_t>(std::max<std::int64_t>(to_ns(scan.stamp), 0)));
  out.point_num(static_cast<std::uint32_t>(scan.points.size()));
  out.points().reserve(scan.points.size());
  for (const sensor::ScanPoint& point : scan.points) {
    constexpr float kMaxNanoseconds = 4.29e9f;
    CustomPoint_ one;
    one.x(point.position.x());
    one.y(point.position.y());
    one.z(point.position.z());
    one.offset_time(static_cast<std::uint32_t>(std::clamp(point.time * 1e9f, 0.0f, kMaxNanoseconds)));
    one.reflectivity(static_cast<std::uint8_t>(std::clamp(point.intensity, 0.0f, 255.0f)));
    one.line(static_cast<std::uint8_t>(std::min<std::uint16_t>(point.ring, 255)));
    out.points().push_back(one);
  }
  return bus::to_cdr(out);
}

Result<DecodedScan> decode_livox(ByteView cdr) {
  const auto in = bus::from_cdr<CustomMsg_>(cdr, type_name::kLivoxDriver2,
                                            [&](auto& stream) { peek_points(stream, cdr.size()); });
  if (!in) return tl::unexpected(in.error());
  const auto stamp = from_ros(in->header().stamp(), type_name::kLivoxDriver2);
  if (!stamp) return tl::unexpected(stamp.error());
  if (in->point_num() != in->points().size())
    return failure(std::string(type_name::kLivoxDriver2) + ": point_num " + std::to_string(in->point_num()) +
                   " contradicts its " + std::to_string(in->points().size()) + " points");
  DecodedScan out;
  out.scan.stamp = *stamp;
  out.scan.has_ring = true;
  out.scan.has_time = has_livox_times(*in);
  const Duration begin = timebase_after_stamp(*in, out);
  out.scan.points.reserve(in->points().size());
  for (const CustomPoint_& point : in->points()) add_point(point, begin, out);
  return out;
}

}  // namespace fleetmap::ros_codec
