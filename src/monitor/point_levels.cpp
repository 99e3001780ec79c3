#include "point_levels.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <utility>

namespace fleetmap::monitor {
namespace {

static_assert(std::endian::native == std::endian::little, "points are sent as they lie in memory");

constexpr float kSteps = 32'767.0f;  // of 16 bits, on either side of the centre
constexpr std::size_t kLevels = 12;  // of grids; the finest has 1/2048 of the coarsest one's edge

struct Box {
  Eigen::Vector3f low = Eigen::Vector3f::Constant(std::numeric_limits<float>::max());
  Eigen::Vector3f high = Eigen::Vector3f::Constant(std::numeric_limits<float>::lowest());
  bool empty() const { return low.x() > high.x(); }
  float half_extent() const { return 0.5f * (high - low).maxCoeff(); }
};

Box box_of(const cloud::PointCloud& cloud) {
  Box box;
  for (const Eigen::Vector3f& p : cloud.points) {
    if (!p.allFinite()) continue;
    box.low = box.low.cwiseMin(p);
    box.high = box.high.cwiseMax(p);
  }
  return box;
}

constexpr float kMaxSteps = 0x1fffff;  // 21 bits an axis

/// Every third bit, from the lowest on, is one of `axis` (Morton 1966).
std::uint64_t spread_bits(std::uint32_t axis) {
  std::uint64_t bits = axis & 0x1fffffu;
  bits = (bits | bits << 32) & 0x1f00000000ffffu;
  bits = (bits | bits << 16) & 0x1f0000ff0000ffu;
  bits = (bits | bits << 8) & 0x100f00f00f00f00fu;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3u;
  return (bits | bits << 2) & 0x1249249249249249u;
}

/// A point and its place along the Z-order curve of the finest grid.
struct PlacedPoint {
  std::uint64_t code;
  std::uint32_t index;
};

/// The finite points, in their order in the cloud.
std::vector<PlacedPoint> placed_points(const cloud::PointCloud& cloud, const Box& box) {
  const float coarsest = std::max(box.half_extent() / 4.0f, 1e-3f);
  const float per_metre = static_cast<float>(1u << (kLevels - 1)) / coarsest;
  std::vector<PlacedPoint> placed;
  placed.reserve(cloud.size());
  for (std::uint32_t k = 0; k < cloud.size(); ++k) {
    const Eigen::Vector3f& p = cloud.points[k];
    if (!p.allFinite()) continue;
    std::uint64_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float along = (p[axis] - box.low[axis]) * per_metre;  // no number in a box without end
      const float steps = along > 0.0f ? std::min(along, kMaxSteps) : 0.0f;
      code |= spread_bits(static_cast<std::uint32_t>(steps)) << axis;
    }
    placed.push_back({code, k});
  }
  return placed;
}

std::vector<PlacedPoint> along_curve(std::vector<PlacedPoint> placed) {
  std::ranges::sort(placed, {}, [](const PlacedPoint& one) { return std::pair(one.code, one.index); });
  return placed;
}

/// The points of all levels up to the one that makes them `points`, along the curve: of each voxel of that
/// level the first point. All points where that level's grid is too fine for a table, or where they are few.
std::vector<PlacedPoint> first_along_curve(std::vector<PlacedPoint> placed, std::size_t points) {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  constexpr std::uint64_t kMaxVoxels = 1u << 22;
  std::uint64_t last = 0;
  for (const PlacedPoint& one : placed) last = std::max(last, one.code);
  for (std::size_t level = 1; level < kLevels && placed.size() > points; ++level) {
    const std::size_t shift = 3 * (kLevels - 1 - level);
    if (last >> shift >= kMaxVoxels) break;
    std::vector<std::uint32_t> first((last >> shift) + 1, kNone);
    std::size_t voxels = 0;
    for (std::uint32_t k = 0; k < placed.size(); ++k) {
      std::uint32_t& one = first[placed[k].code >> shift];
      voxels += one == kNone;
      if (one == kNone || placed[k].code < placed[one].code) one = k;
    }
    if (voxels < points) continue;
    std::vector<PlacedPoint> coarse;
    coarse.reserve(voxels);
    for (const std::uint32_t k : first)
      if (k != kNone) coarse.push_back(placed[k]);
    return coarse;  // a voxel's index lies along the curve as its points do
  }
  return along_curve(std::move(placed));
}

/// The coarsest level at which a point is the first of its voxel along the curve, given the code before it;
/// kLevels if it is at none.
std::size_t level_of(std::uint64_t code, std::uint64_t before) {
  if (code == before) return kLevels;
  const auto highest = static_cast<std::size_t>(63 - std::countl_zero(code ^ before));  // bit that differs
  return kLevels - 1 - std::min(highest / 3, kLevels - 1);
}

/// The first `points` of coarse_to_fine(), and the rest of the level in which they end.
std::vector<std::uint32_t> first_of_order(const std::vector<PlacedPoint>& placed, std::size_t points) {
  std::array<std::vector<std::uint32_t>, kLevels + 1> levels;
  for (std::size_t k = 0; k < placed.size(); ++k)
    levels[k == 0 ? 0 : level_of(placed[k].code, placed[k - 1].code)].push_back(placed[k].index);
  std::vector<std::uint32_t> order;
  order.reserve(placed.size());
  // Mixed within a level, so that the part of one that a prefix holds is spread over the whole, too.
  std::minstd_rand random(1);
  for (std::vector<std::uint32_t>& level : levels) {
    if (order.size() >= points) break;
    for (std::size_t k = level.size(); k > 1; --k) std::swap(level[k - 1], level[random() % k]);
    order.insert(order.end(), level.begin(), level.end());
  }
  return order;
}

/// As kPointHeaderBytes describes it; without gaps.
struct PointHeader {
  std::array<char, 4> magic{'F', 'M', 'P', '1'};
  std::array<float, 3> centre{};
  float scale = 1.0f;
  std::uint32_t whole = 0, from = 0, count = 0, reserved = 0;
};
static_assert(sizeof(PointHeader) == kPointHeaderBytes);

}  // namespace

std::vector<std::uint32_t> coarse_to_fine(const cloud::PointCloud& cloud) {
  const Box box = box_of(cloud);
  return box.empty() ? std::vector<std::uint32_t>{}
                     : first_of_order(along_curve(placed_points(cloud, box)), cloud.size());
}

QuantisedCloud quantised(const cloud::PointCloud& cloud) { return quantised_prefix(cloud, cloud.size()); }

QuantisedCloud quantised_prefix(const cloud::PointCloud& cloud, std::size_t points) {
  QuantisedCloud result;
  const Box box = box_of(cloud);
  if (box.empty()) return result;
  result.centre = 0.5f * (box.low + box.high);
  result.scale = std::max(box.half_extent(), 1e-3f) / kSteps;
  float strongest = 0.0f;
  for (const float intensity : cloud.intensities) {
    if (std::isfinite(intensity)) strongest = std::max(strongest, intensity);
  }
  std::vector<PlacedPoint> placed = placed_points(cloud, box);
  result.whole = placed.size();
  std::vector<std::uint32_t> order = first_of_order(first_along_curve(std::move(placed), points), points);
  order.resize(std::min(order.size(), points));
  result.values.reserve(4 * order.size());
  for (const std::uint32_t k : order) {
    const Eigen::Vector3f steps = (cloud.points[k] - result.centre) / result.scale;
    for (int axis = 0; axis < 3; ++axis)
      result.values.push_back(
          static_cast<std::int16_t>(std::lround(std::clamp(steps[axis], -kSteps, kSteps))));
    const bool has_intensity =
        cloud.has_intensities() && strongest > 0.0f && std::isfinite(cloud.intensities[k]);
    const float share = has_intensity ? cloud.intensities[k] / strongest : 0.0f;
    result.values.push_back(static_cast<std::int16_t>(std::lround(kSteps * std::clamp(share, 0.0f, 1.0f))));
  }
  return result;
}

QuantisedCloud prefix_of(const QuantisedCloud& cloud, std::size_t points) {
  const auto end = cloud.values.begin() + static_cast<std::ptrdiff_t>(4 * std::min(points, cloud.size()));
  return {cloud.centre, cloud.scale, {cloud.values.begin(), end}, cloud.whole};
}

Bytes encoded_points(const QuantisedCloud& cloud, std::size_t from, std::size_t count) {
  from = std::min(from, cloud.size());
  count = std::min(count, cloud.size() - from);
  PointHeader header;
  header.centre = {cloud.centre.x(), cloud.centre.y(), cloud.centre.z()};
  header.scale = cloud.scale;
  header.whole = static_cast<std::uint32_t>(cloud.whole);
  header.from = static_cast<std::uint32_t>(from);
  header.count = static_cast<std::uint32_t>(count);
  Bytes bytes(kPointHeaderBytes + 8 * count);
  std::memcpy(bytes.data(), &header, kPointHeaderBytes);
  if (count > 0) std::memcpy(bytes.data() + kPointHeaderBytes, cloud.values.data() + 4 * from, 8 * count);
  return bytes;
}

std::optional<QuantisedCloud> decoded_points(ByteView bytes) {
  PointHeader header;
  if (bytes.size() < kPointHeaderBytes) return std::nullopt;
  std::memcpy(&header, bytes.data(), kPointHeaderBytes);
  const bool meant = header.magic == PointHeader{}.magic && header.from == 0 && header.count <= header.whole;
  if (!meant || (bytes.size() - kPointHeaderBytes) / 8 < header.count) return std::nullopt;
  QuantisedCloud cloud;
  cloud.centre = {header.centre[0], header.centre[1], header.centre[2]};
  cloud.scale = header.scale;
  cloud.whole = header.whole;
  if (!cloud.centre.allFinite() || !std::isfinite(cloud.scale) || cloud.scale <= 0.0f) return std::nullopt;
  cloud.values.resize(4 * std::size_t{header.count});
  if (header.count > 0)
    std::memcpy(cloud.values.data(), bytes.data() + kPointHeaderBytes, 8 * std::size_t{header.count});
  return cloud;
}

}  // namespace fleetmap::monitor
