#include "fleetmap/ros_codec/point_cloud2.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "fleetmap/bus/cdr.hpp"
#include "fleetmap/core/text_list.hpp"
#include "point_datatype.hpp"
#include "ros_time.hpp"
#include "sensor_msgs.h"
#include "type_names.hpp"

namespace fleetmap::ros_codec {
namespace {

using sensor_msgs::msg::dds_::PointCloud2_;
using sensor_msgs::msg::dds_::PointField_;

constexpr std::array<std::size_t, 9> kSizes{0, 1, 1, 2, 2, 4, 4, 4, 8};

constexpr std::uint32_t kMaxFields = 256;
constexpr double kMaxScanSeconds = 10.0;  // point times further from the stamp are not relative to it
constexpr double kMinSweep = 5e3;         // integer units of point time, were they microseconds
constexpr double kShortestInNanoseconds = 1e6;
constexpr double kNanosecondsBeyond = 1e12;  // a float time beyond this is in ns: 1e12 s is no date

constexpr double kShortestSweep = 5e-3, kLongestSweep = 1.0;  // s
constexpr double kMiddleShare = 0.2;
constexpr double kEarliestDate = 1e8, kDay = 86'400.0;  // s
constexpr std::array kFloatUnits{std::pair{TimeUnit::kMilliseconds, 1e-3},
                                 std::pair{TimeUnit::kMicroseconds, 1e-6},
                                 std::pair{TimeUnit::kNanoseconds, 1e-9}};

/// One field of every point, in its own type and byte order.
struct Field {
  std::size_t offset = 0;
  std::uint8_t datatype = 0;
  bool swap = false;

  template <class T>
  double load(const std::uint8_t* at) const {
    std::array<std::uint8_t, sizeof(T)> raw;
    std::memcpy(raw.data(), at + offset, sizeof(T));
    if (swap) std::reverse(raw.begin(), raw.end());
    return static_cast<double>(std::bit_cast<T>(raw));
  }
  double value(const std::uint8_t* point) const {
    switch (datatype) {
      case kInt8:
        return load<std::int8_t>(point);
      case kUint8:
        return load<std::uint8_t>(point);
      case kInt16:
        return load<std::int16_t>(point);
      case kUint16:
        return load<std::uint16_t>(point);
      case kInt32:
        return load<std::int32_t>(point);
      case kUint32:
        return load<std::uint32_t>(point);
      case kFloat32:
        return load<float>(point);
      default:
        return load<double>(point);
    }
  }
  bool is_float() const { return datatype == kFloat32 || datatype == kFloat64; }
};

struct Layout {
  std::array<Field, 3> xyz;
  std::optional<Field> intensity, ring, time;
};

tl::unexpected<Error> refused_cloud(const std::string& what) {
  std::string message = type_name::kPointCloud2;  // GCC 12 warns wrongly of a sum of the three
  return failure(message.append(": ").append(what));
}

Status check_extent(const PointCloud2_& in) {
  const std::uint64_t height = in.height(), width = in.width();
  const std::uint64_t point_step = in.point_step(), row_step = in.row_step();
  if (height == 0 || width == 0) return {};
  if (point_step == 0) return refused_cloud("point_step is 0");
  // Unorganised clouds of some drivers leave row_step at 0.
  const std::uint64_t row_bytes = row_step == 0 && height == 1 ? width * point_step : row_step;
  if (row_bytes < width * point_step) {
    return refused_cloud("row_step " + std::to_string(row_step) + " is less than width " +
                         std::to_string(width) + " x point_step " + std::to_string(point_step));
  }
  if (in.data().size() < (height - 1) * row_bytes + width * point_step) {
    return refused_cloud("data has " + std::to_string(in.data().size()) + " bytes, too few for height " +
                         std::to_string(height) + " x row_step " + std::to_string(row_bytes));
  }
  return {};
}

/// The field of one of the `names`, if its datatype is among `types`.
template <std::size_t N, std::size_t M>
std::optional<Field> find_field(const PointCloud2_& in, const std::array<const char*, N>& names,
                                const std::array<PointDatatype, M>& types) {
  for (const char* name : names) {
    for (const PointField_& field : in.fields()) {
      const bool wanted = field.name() == name && std::ranges::find(types, field.datatype()) != types.end();
      if (!wanted || std::uint64_t{field.offset()} + kSizes[field.datatype()] > in.point_step()) continue;
      const bool foreign = in.is_bigendian() != (std::endian::native == std::endian::big);
      return Field{field.offset(), field.datatype(), foreign};
    }
  }
  return std::nullopt;
}

Result<Layout> read_layout(const PointCloud2_& in) {
  constexpr std::array kAny{kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64};
  constexpr std::array kNames{"x", "y", "z"};
  Layout layout;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto field = find_field(in, std::array{kNames[axis]}, std::array{kFloat32, kFloat64});
    if (!field) {
      std::string present;
      for (const PointField_& f : in.fields()) append_to_list(present, f.name().substr(0, 32));
      return refused_cloud(std::string("no field '") + kNames[axis] +
                           "' of float32 or float64 within point_step; fields: " + present);
    }
    layout.xyz[axis] = *field;
  }
  layout.intensity = find_field(in, std::array{"intensity"}, kAny);
  layout.ring = find_field(in, std::array{"ring", "channel"}, std::array{kUint8, kUint16, kUint32});
  layout.time = find_field(in, std::array{"time", "t", "timestamp", "offset_time", "time_stamp"},
                           std::array{kUint32, kFloat32, kFloat64});
  return layout;
}

/// The unit of floats from 0 on that last a sweep of 5 ms to 1 s in one unit alone. One stray point does not
/// decide it: the middle half of the times has to reach over a fifth of the sweep.
TimeUnit unit_of_floats(std::vector<double> times, double span) {
  if (span <= kLongestSweep) return TimeUnit::kAsDefined;
  const auto quarter = static_cast<std::ptrdiff_t>(times.size() / 4);
  const auto low = times.begin() + quarter, high = times.end() - 1 - quarter;
  std::ranges::nth_element(times, low);
  const double first = *low;
  std::ranges::nth_element(times, high);
  if (*high - first < kMiddleShare * span) return TimeUnit::kUnclear;
  for (const auto& [unit, seconds] : kFloatUnits) {
    if (span * seconds >= kShortestSweep && span * seconds <= kLongestSweep) return unit;
  }
  return TimeUnit::kUnclear;
}

/// Milli- or microseconds, if times from `earliest` on are of the stamp's day and a sweep in this unit. Units
/// are a thousand apart, so a stamp since 1970 leaves one at most; nothing is concluded from a stamp since
/// boot.
std::optional<TimeUnit> unit_of_date(double earliest, double span, Stamp stamp) {
  const double date = to_seconds(stamp);
  for (const auto& [unit, seconds] : kFloatUnits) {
    const bool same_day = date > kEarliestDate && std::abs(earliest * seconds - date) < kDay;
    const bool sweep = span * seconds >= kShortestSweep && span * seconds <= kLongestSweep;
    if (same_day && sweep && unit != TimeUnit::kNanoseconds) return unit;
  }
  return std::nullopt;
}

double seconds_of(TimeUnit unit, double as_defined) {
  for (const auto& [other, seconds] : kFloatUnits) {
    if (unit == other) return seconds;
  }
  return as_defined;
}

/// Point times as read, in the field's own unit, become seconds after the stamp.
void resolve_times(std::vector<double>& times, const Field& field, Stamp stamp, DecodedScan& out) {
  double earliest = std::numeric_limits<double>::infinity(), latest = -earliest;
  for (const double time : times) {
    if (!std::isfinite(time)) return;  // no time at all is better than some that are not
    earliest = std::min(earliest, time);
    latest = std::max(latest, time);
  }
  const double largest = std::max(std::abs(earliest), std::abs(latest));
  const bool nanoseconds = !field.is_float() || largest > kNanosecondsBeyond;
  // A sweep takes 5 ms to 1 s, which is less than 1 ms if microseconds are taken for nanoseconds.
  const double span = latest - earliest;
  if (!field.is_float() && span >= kMinSweep && span < kShortestInNanoseconds)
    out.time_unit = TimeUnit::kMicroseconds;
  // Floats that are relative to the stamp: the largest of them is about the sweep.
  if (field.is_float() && largest <= 2.0 * span) out.time_unit = unit_of_floats(times, span);
  if (out.time_unit == TimeUnit::kUnclear) return;
  const auto dated = field.datatype == kFloat64 ? unit_of_date(earliest, span, stamp) : std::nullopt;
  if (dated) out.time_unit = *dated;
  const double unit = seconds_of(out.time_unit, nanoseconds ? 1e-9 : 1.0);
  double zero = 0.0;
  if (times.size() > 1 && latest == earliest) return;  // a driver that leaves the field at a constant
  if (largest * unit > kMaxScanSeconds) {
    if (field.datatype == kFloat32) return;  // cannot resolve a scan in absolute time
    // Absolute. The stamp in the field's unit has the field's own rounding, so the difference is exact
    // enough. Microseconds of 32 bits cannot count from 1970.
    const double start = nanoseconds && !dated ? static_cast<double>(to_ns(stamp)) : to_seconds(stamp) / unit;
    const bool undated = out.time_unit != TimeUnit::kAsDefined && !dated;
    out.foreign_clock = undated || std::abs(earliest - start) * unit > kMaxScanSeconds;
    zero = out.foreign_clock ? earliest : start;
  }
  if (span * unit > kMaxScanSeconds) return;  // not the time within one scan
  for (std::size_t k = 0; k < times.size(); ++k) {
    out.scan.points[k].time = static_cast<float>((times[k] - zero) * unit);
  }
  out.scan.has_time = true;
}

void read_points(const PointCloud2_& in, const Layout& layout, DecodedScan& out) {
  std::vector<double> times;
  const std::size_t count = std::size_t{in.height()} * in.width();
  out.scan.has_ring = layout.ring.has_value();
  if (count == 0) return;  // billions of rows without a point would still be walked
  out.scan.points.reserve(count);
  if (layout.time) times.reserve(count);
  for (std::uint32_t row = 0; row < in.height(); ++row) {
    const std::uint8_t* at = in.data().data() + std::size_t{row} * in.row_step();
    for (std::uint32_t column = 0; column < in.width(); ++column, at += in.point_step()) {
      sensor::ScanPoint point;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        point.position[static_cast<int>(axis)] = static_cast<float>(layout.xyz[axis].value(at));
      }
      if (!point.position.allFinite()) {
        ++out.non_finite_points;
        continue;
      }
      if (point.position.isZero(0.0f)) {
        ++out.origin_points;
        continue;
      }
      if (layout.intensity) point.intensity = static_cast<float>(layout.intensity->value(at));
      if (layout.ring) point.ring = static_cast<std::uint16_t>(std::min(layout.ring->value(at), 65535.0));
      if (layout.time) times.push_back(layout.time->value(at));
      out.scan.points.push_back(point);
    }
  }
  if (layout.time && !times.empty()) resolve_times(times, *layout.time, out.scan.stamp, out);
}

/// Refuses an absurd number of fields before they are allocated.
void peek_fields(eprosima::fastcdr::Cdr& cdr) {
  std_msgs::msg::dds_::Header_ header;
  std::uint32_t height = 0, width = 0, fields = 0;
  header.deserialize(cdr);
  cdr >> height >> width >> fields;
  if (fields > kMaxFields) throw std::length_error(std::to_string(fields) + " point fields");
}

void add_field(PointCloud2_& out, const char* name, std::uint32_t offset, PointDatatype datatype) {
  PointField_ field;
  field.name(name);
  field.offset(offset);
  field.datatype(datatype);
  field.count(1);
  out.fields().push_back(field);
}

}  // namespace

std::string finding_of(TimeUnit unit) {
  const auto converted = [](const char* name) {
    return std::string("LiDAR: point times are in ") + name +
           ", although their field's definition is nanoseconds for integers and seconds for floats; they are "
           "converted. Correct the driver";
  };
  switch (unit) {
    case TimeUnit::kMicroseconds:
      return converted("microseconds");
    case TimeUnit::kMilliseconds:
      return converted("milliseconds");
    case TimeUnit::kNanoseconds:
      return converted("nanoseconds");
    case TimeUnit::kUnclear:
      return "LiDAR: point times are floats that last a sweep of 5 ms to 1 s in no unit; they are not used, "
             "so the motion within a sweep is taken from the order of the points. Correct the driver: "
             "seconds "
             "after the stamp";
    default:
      return {};
  }
}

Bytes encode(const sensor::Scan& scan, std::string_view frame_id) {
  PointCloud2_ out;
  out.header().stamp(to_ros(scan.stamp));
  out.header().frame_id(std::string(frame_id));
  std::uint32_t step = 0;
  for (const char* name : {"x", "y", "z", "intensity"}) {
    add_field(out, name, step, kFloat32);
    step += 4;
  }
  const std::uint32_t time_offset = step;
  if (scan.has_time) {
    add_field(out, "time", step, kFloat32);
    step += 4;
  }
  const std::uint32_t ring_offset = step;
  if (scan.has_ring) {
    add_field(out, "ring", step, kUint16);
    step += 2;
  }
  out.height(1);
  out.width(static_cast<std::uint32_t>(scan.points.size()));
  out.point_step(step);
  out.row_step(static_cast<std::uint32_t>(step * scan.points.size()));
  out.is_bigendian(std::endian::native == std::endian::big);
  out.is_dense(true);
  out.data().resize(step * scan.points.size());
  std::uint8_t* at = out.data().data();
  for (const sensor::ScanPoint& point : scan.points) {
    std::memcpy(at, point.position.data(), 12);
    std::memcpy(at + 12, &point.intensity, 4);
    if (scan.has_time) std::memcpy(at + time_offset, &point.time, 4);
    if (scan.has_ring) std::memcpy(at + ring_offset, &point.ring, 2);
    at += step;
  }
  return bus::to_cdr(out);
}

Result<DecodedScan> decode_scan(ByteView cdr) {
  const auto in = bus::from_cdr<PointCloud2_>(cdr, type_name::kPointCloud2, peek_fields);
  if (!in) return tl::unexpected(in.error());
  const auto stamp = from_ros(in->header().stamp(), type_name::kPointCloud2);
  if (!stamp) return tl::unexpected(stamp.error());
  if (auto extent = check_extent(*in); !extent) return tl::unexpected(extent.error());
  const auto layout = read_layout(*in);
  if (!layout) return tl::unexpected(layout.error());
  DecodedScan out;
  out.scan.stamp = *stamp;
  read_points(*in, *layout, out);
  return out;
}

template <>
Result<sensor::Scan> decode(ByteView cdr) {
  auto decoded = decode_scan(cdr);
  if (!decoded) return tl::unexpected(decoded.error());
  return std::move(decoded->scan);
}

}  // namespace fleetmap::ros_codec
