#include "point_levels.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <unordered_set>

namespace fleetmap::monitor {
namespace {

static_assert(std::endian::native == std::endian::little, "points are sent as they lie in memory");

constexpr float kSteps = 32'767.0f;  // of 16 bits, on either side of the centre
constexpr int kLevels = 12;          // of grids; the finest has 1/2048 of the coarsest one's edge

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

/// 21 bits an axis.
std::uint64_t voxel_of(const Eigen::Vector3f& from_low, float edge) {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis)
    key = key << 21 | (static_cast<std::uint64_t>(from_low[axis] / edge) & 0x1fffffu);
  return key;
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
  std::vector<std::uint32_t> left, order;
  for (std::uint32_t k = 0; k < cloud.size(); ++k) {
    if (cloud.points[k].allFinite()) left.push_back(k);
  }
  if (box.empty()) return order;
  order.reserve(left.size());
  float edge = std::max(box.half_extent() / 4.0f, 1e-3f);
  std::unordered_set<std::uint64_t> taken;
  for (int level = 0; level < kLevels && !left.empty(); ++level, edge /= 2.0f) {
    // A voxel of this level that holds a point of a coarser one is represented already.
    taken.clear();
    for (const std::uint32_t k : order) taken.insert(voxel_of(cloud.points[k] - box.low, edge));
    std::vector<std::uint32_t> rest;
    for (const std::uint32_t k : left) {
      const bool first = taken.insert(voxel_of(cloud.points[k] - box.low, edge)).second;
      (first ? order : rest).push_back(k);
    }
    left = std::move(rest);
  }
  order.insert(order.end(), left.begin(), left.end());
  return order;
}

QuantisedCloud quantised(const cloud::PointCloud& cloud) {
  QuantisedCloud result;
  const Box box = box_of(cloud);
  if (box.empty()) return result;
  result.centre = 0.5f * (box.low + box.high);
  result.scale = std::max(box.half_extent(), 1e-3f) / kSteps;
  float strongest = 0.0f;
  for (const float intensity : cloud.intensities) {
    if (std::isfinite(intensity)) strongest = std::max(strongest, intensity);
  }
  const std::vector<std::uint32_t> order = coarse_to_fine(cloud);
  result.values.reserve(4 * order.size());
  for (const std::uint32_t k : order) {
    const Eigen::Vector3f steps = (cloud.points[k] - result.centre) / result.scale;
    for (int axis = 0; axis < 3; ++axis)
      result.values.push_back(
          static_cast<std::int16_t>(std::lround(std::clamp(steps[axis], -kSteps, kSteps))));
    const bool seen = cloud.has_intensities() && strongest > 0.0f && std::isfinite(cloud.intensities[k]);
    const float share = seen ? cloud.intensities[k] / strongest : 0.0f;
    result.values.push_back(static_cast<std::int16_t>(std::lround(kSteps * std::clamp(share, 0.0f, 1.0f))));
  }
  return result;
}

Bytes encoded_points(const QuantisedCloud& cloud, std::size_t from, std::size_t count) {
  from = std::min(from, cloud.size());
  count = std::min(count, cloud.size() - from);
  PointHeader header;
  header.centre = {cloud.centre.x(), cloud.centre.y(), cloud.centre.z()};
  header.scale = cloud.scale;
  header.whole = static_cast<std::uint32_t>(cloud.size());
  header.from = static_cast<std::uint32_t>(from);
  header.count = static_cast<std::uint32_t>(count);
  Bytes bytes(kPointHeaderBytes + 8 * count);
  std::memcpy(bytes.data(), &header, kPointHeaderBytes);
  if (count > 0) std::memcpy(bytes.data() + kPointHeaderBytes, cloud.values.data() + 4 * from, 8 * count);
  return bytes;
}

}  // namespace fleetmap::monitor
