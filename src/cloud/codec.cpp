#include "fleetmap/cloud/codec.hpp"

#include <draco/compression/decode.h>
#include <draco/compression/expert_encode.h>
#include <draco/point_cloud/point_cloud_builder.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <exception>
#include <initializer_list>
#include <limits>
#include <string>

namespace fleetmap::cloud {
namespace {

// Layout (little-endian): magic[2] version flags | checksum u32 of all that follows | count u32 | resolution
// f64 | origin in grid steps 3 x i64 | [intensity low f32, high f32] | bits u8 | Draco's body. Draco's own
// header is the same for every cloud of ours, so it is cut off when encoding and put back when decoding: a
// sender cannot choose it.
constexpr std::array<std::uint8_t, 3> kMagic{'F', 'C', 1};
constexpr std::uint8_t kFlagIntensities = 1;
constexpr std::size_t kChecksumEnd = 8;
constexpr double kMaxSteps = 1073741824.0;  // 2^30
constexpr double kMaxOrigin = 9007199254740992.0;
constexpr int kDracoSpeed = 3;  // k-d tree level 6: the densest

struct CodeGrid {
  double resolution = 0.0;
  std::array<std::int64_t, 3> origin{};
};

std::uint32_t checksum(ByteView bytes) {  // CRC-32 (IEEE 802.3)
  static const auto table = [] {
    std::array<std::uint32_t, 256> t{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      std::uint32_t c = i;
      for (int k = 0; k < 8; ++k) c = (c & 1u) != 0 ? 0xEDB88320u ^ (c >> 1) : c >> 1;
      t[i] = c;
    }
    return t;
  }();
  std::uint32_t crc = 0xFFFFFFFFu;
  for (const std::uint8_t byte : bytes) crc = table[(crc ^ byte) & 0xFFu] ^ (crc >> 8);
  return ~crc;
}

template <class T>
void put(Bytes& out, T value) {
  const std::size_t at = out.size();
  out.resize(at + sizeof value);
  std::memcpy(out.data() + at, &value, sizeof value);
}

/// Reads from the front; `ok` turns false for good at the first read past the end.
struct Reader {
  ByteView rest;
  bool ok = true;
  template <class T>
  T take() {
    T value{};
    if (rest.size() < sizeof value) {
      ok = false;
      return value;
    }
    std::memcpy(&value, rest.data(), sizeof value);
    rest = rest.subspan(sizeof value);
    return value;
  }
};

/// The bytes that Draco 2.3 writes before the body of a cloud with one u32 x 3 attribute (and one u8 x 1).
Bytes draco_header(std::uint32_t count, bool intensities, std::uint32_t bits) {
  Bytes header;
  header.reserve(64);
  const auto put_all = [&header](std::initializer_list<std::uint8_t> bytes) {
    for (const std::uint8_t byte : bytes) header.push_back(byte);
  };
  put_all({'D', 'R', 'A', 'C', 'O', 2, 3, 0, 1, 0, 0});
  put(header, count);
  put_all({1, static_cast<std::uint8_t>(intensities ? 2 : 1), 0, 6, 3, 0, 0});
  if (intensities) put_all({4, 2, 1, 0, 1});
  header.push_back(6);
  put(header, bits);
  put(header, count);
  return header;
}

Result<CodeGrid> grid_of(const PointCloud& cloud, double resolution) {
  Eigen::Array3d low = cloud.points.front().cast<double>();
  Eigen::Array3d high = low;
  for (const Eigen::Vector3f& p : cloud.points) {
    if (!p.allFinite()) return failure("cloud encoding: the cloud has non-finite points; remove them first");
    low = low.min(p.cast<double>().array());
    high = high.max(p.cast<double>().array());
  }
  const Eigen::Array3d origin = (low / resolution).round();
  if (((high - low) / resolution > kMaxSteps).any() || (origin.abs() > kMaxOrigin).any()) {
    return failure("cloud encoding: the cloud spans more than 2^30 steps of " + std::to_string(resolution) +
                   " m");
  }
  return CodeGrid{resolution,
                  {static_cast<std::int64_t>(origin[0]), static_cast<std::int64_t>(origin[1]),
                   static_cast<std::int64_t>(origin[2])}};
}

std::vector<std::uint32_t> grid_points(const PointCloud& cloud, const CodeGrid& grid) {
  std::vector<std::uint32_t> steps;
  steps.reserve(3 * cloud.size());
  for (const Eigen::Vector3f& p : cloud.points) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double step = static_cast<double>(p[static_cast<Eigen::Index>(axis)]) / grid.resolution;
      steps.push_back(static_cast<std::uint32_t>(std::llround(step) - grid.origin[axis]));
    }
  }
  return steps;
}

struct IntensityRange {
  float low = 0.0f;
  float high = 0.0f;
};

IntensityRange intensity_range(const std::vector<float>& intensities) {
  IntensityRange range{std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest()};
  for (const float value : intensities) {
    if (!std::isfinite(value)) continue;
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
  }
  return range.low <= range.high ? range : IntensityRange{};
}

std::vector<std::uint8_t> quantised(const std::vector<float>& intensities, const IntensityRange& range) {
  std::vector<std::uint8_t> levels;
  levels.reserve(intensities.size());
  const double span = std::max(static_cast<double>(range.high) - static_cast<double>(range.low), 1e-30);
  for (const float value : intensities) {
    const double level = (static_cast<double>(value) - static_cast<double>(range.low)) / span * 255.0;
    levels.push_back(
        std::isfinite(level) ? static_cast<std::uint8_t>(std::lround(std::clamp(level, 0.0, 255.0))) : 0);
  }
  return levels;
}

Result<draco::EncoderBuffer> draco_encode(const std::vector<std::uint32_t>& steps,
                                          const std::vector<std::uint8_t>& levels) {
  draco::PointCloudBuilder builder;
  builder.Start(static_cast<std::uint32_t>(steps.size() / 3));
  const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_UINT32);
  builder.SetAttributeValuesForAllPoints(position, steps.data(), 0);
  if (!levels.empty()) {
    const int intensity = builder.AddAttribute(draco::GeometryAttribute::GENERIC, 1, draco::DT_UINT8);
    builder.SetAttributeValuesForAllPoints(intensity, levels.data(), 0);
  }
  const auto points = builder.Finalize(false);
  draco::ExpertEncoder encoder(*points);
  encoder.SetEncodingMethod(draco::POINT_CLOUD_KD_TREE_ENCODING);
  encoder.SetSpeedOptions(kDracoSpeed, kDracoSpeed);
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodeToBuffer(&buffer);
  if (!status.ok()) return failure(std::string("cloud encoding: ") + status.error_msg());
  return buffer;
}

/// Everything of an encoded cloud but Draco's body.
struct Header {
  std::uint32_t count = 0;
  bool intensities = false;
  CodeGrid grid;
  IntensityRange range;
  std::uint8_t bits = 0;
};

void put_header(Bytes& out, const Header& header) {
  put(out, header.count);
  put(out, header.grid.resolution);
  for (const std::int64_t step : header.grid.origin) put(out, step);
  if (header.intensities) {
    put(out, header.range.low);
    put(out, header.range.high);
  }
  out.push_back(header.bits);
}

Result<Header> take_header(Reader& in, std::uint8_t flags, std::size_t max_points) {
  Header header;
  header.intensities = (flags & kFlagIntensities) != 0;
  header.count = in.take<std::uint32_t>();
  header.grid.resolution = in.take<double>();
  bool sane = std::isfinite(header.grid.resolution) && header.grid.resolution > 0.0;
  for (std::int64_t& step : header.grid.origin) {
    step = in.take<std::int64_t>();
    sane = sane && std::abs(static_cast<double>(step)) <= kMaxOrigin;
  }
  if (header.intensities) {
    header.range.low = in.take<float>();
    header.range.high = in.take<float>();
    sane = sane && std::isfinite(header.range.low) && std::isfinite(header.range.high);
  }
  header.bits = in.take<std::uint8_t>();
  if (!in.ok) return failure("encoded cloud: truncated");
  if (!sane || header.bits > 32) return failure("encoded cloud: damaged header");
  if (header.count > max_points) {
    return failure("encoded cloud: claims " + std::to_string(header.count) + " points, at most " +
                   std::to_string(max_points) + " are accepted");
  }
  return header;
}

Result<PointCloud> cloud_from(const draco::PointCloud& points, const Header& header) {
  const auto* position = points.GetNamedAttribute(draco::GeometryAttribute::POSITION);
  const auto* intensity = points.GetNamedAttribute(draco::GeometryAttribute::GENERIC);
  if (points.num_points() != header.count || position == nullptr || position->num_components() != 3 ||
      position->data_type() != draco::DT_UINT32 || (header.intensities && intensity == nullptr)) {
    return failure("encoded cloud: damaged body");
  }
  PointCloud cloud;
  cloud.points.reserve(header.count);
  const float span = header.range.high - header.range.low;
  for (draco::PointIndex i(0); i < header.count; ++i) {
    std::array<std::uint32_t, 3> steps{};
    position->GetMappedValue(i, steps.data());
    Eigen::Vector3f p;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      p[static_cast<Eigen::Index>(axis)] = static_cast<float>(
          static_cast<double>(header.grid.origin[axis] + steps[axis]) * header.grid.resolution);
    }
    if (!p.allFinite()) return failure("encoded cloud: damaged body");
    cloud.points.push_back(p);
    if (header.intensities) {
      std::uint8_t level = 0;
      intensity->GetMappedValue(i, &level);
      cloud.intensities.push_back(header.range.low + span * static_cast<float>(level) / 255.0f);
    }
  }
  return cloud;
}

}  // namespace

Result<Bytes> encode(const PointCloud& cloud, const CodecConfig& config) {
  if (auto valid = config.validate(); !valid) return failure(valid.error().message);
  if (cloud.size() > kMaxEncodedPoints) {
    return failure("cloud encoding: " + std::to_string(cloud.size()) + " points, at most " +
                   std::to_string(kMaxEncodedPoints) + " fit; downsample first");
  }
  Header header;
  header.count = static_cast<std::uint32_t>(cloud.size());
  header.intensities = config.encode_intensities && cloud.has_intensities() && !cloud.empty();
  header.grid.resolution = config.resolution_m;
  Bytes body;
  if (!cloud.empty()) {
    const auto grid = grid_of(cloud, config.resolution_m);
    if (!grid) return failure(grid.error().message);
    header.grid = *grid;
    if (header.intensities) header.range = intensity_range(cloud.intensities);
    const auto buffer = draco_encode(
        grid_points(cloud, *grid),
        header.intensities ? quantised(cloud.intensities, header.range) : std::vector<std::uint8_t>{});
    if (!buffer) return failure(buffer.error().message);
    const Bytes whole(buffer->data(), buffer->data() + buffer->size());
    const std::size_t header_size = draco_header(0, header.intensities, 0).size();
    if (whole.size() >= header_size) header.bits = whole[header_size - 8];
    const Bytes expected = draco_header(header.count, header.intensities, header.bits);
    if (whole.size() < header_size || !std::equal(expected.begin(), expected.end(), whole.begin())) {
      return failure("cloud encoding: this Draco writes another format than 2.3");
    }
    body.assign(whole.begin() + static_cast<std::ptrdiff_t>(header_size), whole.end());
  }
  Bytes out(kMagic.begin(), kMagic.end());
  out.push_back(header.intensities ? kFlagIntensities : 0);
  put(out, std::uint32_t{0});
  put_header(out, header);
  out.insert(out.end(), body.begin(), body.end());
  if (cloud.size() > max_points_in(out.size())) {
    return failure("cloud encoding: " + std::to_string(cloud.size()) + " points fit into " +
                   std::to_string(out.size()) + " bytes, so most are the same; downsample first");
  }
  const std::uint32_t sum = checksum(ByteView(out).subspan(kChecksumEnd));
  std::memcpy(out.data() + 4, &sum, sizeof sum);
  return out;
}

Result<PointCloud> decode(ByteView bytes, std::size_t max_points) {
  Reader in{bytes};
  for (const std::uint8_t magic : kMagic) {
    if (in.take<std::uint8_t>() != magic) return failure("encoded cloud: not a cloud of version 1");
  }
  const auto flags = in.take<std::uint8_t>();
  const auto sum = in.take<std::uint32_t>();
  if (!in.ok || flags > kFlagIntensities) return failure("encoded cloud: damaged header");
  if (sum != checksum(in.rest)) return failure("encoded cloud: checksum differs: truncated or damaged");
  const auto header = take_header(in, flags, std::min(max_points, max_points_in(bytes.size())));
  if (!header) return failure(header.error().message);
  if (header->count == 0) return PointCloud{};
  Bytes whole = draco_header(header->count, header->intensities, header->bits);
  whole.insert(whole.end(), in.rest.begin(), in.rest.end());
  try {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(whole.data()), whole.size());
    draco::Decoder decoder;
    auto points = decoder.DecodePointCloudFromBuffer(&buffer);
    if (!points.ok()) return failure(std::string("encoded cloud: ") + points.status().error_msg());
    return cloud_from(*points.value(), *header);
  } catch (const std::exception& error) {
    return failure(std::string("encoded cloud: ") + error.what());
  }
}

}  // namespace fleetmap::cloud
