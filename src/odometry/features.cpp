#include "fleetmap/odometry/features.hpp"

#include <algorithm>
#include <cmath>

namespace fleetmap::odometry {
namespace {

constexpr std::size_t kMinNeighbours = 2;
constexpr std::size_t kMaxNeighbours = 12;
/// A jump in range between neighbours that is a break in the surface: an offset plus a share of the range.
constexpr float kBreakOffset = 0.15f;
constexpr float kBreakShare = 0.03f;
constexpr float kPostMaxWidth = 0.4f;
constexpr std::size_t kPostMinPoints = 2;

}  // namespace

FeatureExtractor::FeatureExtractor(const LoamConfig& config)
    : half_width_(config.feature_half_width),
      plane_max_deviation_(config.plane_max_deviation),
      edge_min_deviation_(config.edge_min_deviation),
      edge_min_angle_(config.edge_min_angle) {}

const Features& FeatureExtractor::extract(const Sweep& sweep) {
  features_.edges.clear();
  features_.planes.clear();
  for (std::size_t r = 0; r < sweep.rings(); ++r) {
    const auto points = sweep.ring(r);
    if (points.size() < 2 * kMinNeighbours + 1) continue;
    find_breaks(points);
    measure_ring(sweep, r);
    select_plane_points(sweep.ring_begin[r], points.size());
    select_bends(sweep.ring_begin[r], points.size());
    select_posts(points, sweep.ring_begin[r]);
  }
  const std::size_t ringless = sweep.rings() == 0 ? 0 : sweep.ring_begin.back();
  for (std::size_t i = ringless; i < sweep.points.size(); ++i) {
    features_.planes.push_back(static_cast<std::uint32_t>(i));
  }
  return features_;
}

/// Splits the ring where neighbours do not lie on one surface: the gap is large for that range.
void FeatureExtractor::find_breaks(std::span<const SweepPoint> points) {
  const std::size_t n = points.size();
  segment_begin_.resize(n);
  segment_end_.resize(n);
  std::size_t begin = 0;
  for (std::size_t i = 0; i < n; ++i) {
    segment_begin_[i] = static_cast<std::uint32_t>(begin);
    const bool last = i + 1 == n;
    const float gap = last ? 0.0f : (points[i + 1].position - points[i].position).squaredNorm();
    const float limit = kBreakOffset + kBreakShare * points[i].range;
    if (!last && gap <= limit * limit) continue;
    for (std::size_t j = begin; j <= i; ++j) segment_end_[j] = static_cast<std::uint32_t>(i + 1);
    begin = i + 1;
  }
}

/// Deviation of each point from the chord between the centroids of its neighbours on either side.
void FeatureExtractor::measure_ring(const Sweep& sweep, std::size_t ring) {
  const auto points = sweep.ring(ring);
  const std::size_t n = points.size();
  sums_.resize(n + 1);
  sums_[0].setZero();
  const Eigen::Vector3f origin = points[0].position;
  for (std::size_t i = 0; i < n; ++i) sums_[i + 1] = sums_[i] + (points[i].position - origin).cast<double>();
  deviation_.assign(n, -1.0f);
  bend_.assign(n, -1.0f);
  half_count_.assign(n, 0);
  for (std::size_t i = kMinNeighbours; i + kMinNeighbours < n; ++i) {
    const Eigen::Vector3f& p = points[i].position;
    const float spacing = 0.5f * (points[i + 1].position - points[i - 1].position).norm() + 1e-3f;
    const std::size_t k = std::clamp(static_cast<std::size_t>(static_cast<float>(half_width_) / spacing),
                                     kMinNeighbours, kMaxNeighbours);
    half_count_[i] = static_cast<std::uint8_t>(k);
    if (i < segment_begin_[i] + k || i + k >= segment_end_[i]) continue;
    const double scale = 1.0 / static_cast<double>(k);
    const Eigen::Vector3f left = ((sums_[i] - sums_[i - k]) * scale).cast<float>() + origin - p;
    const Eigen::Vector3f right = ((sums_[i + k + 1] - sums_[i + 1]) * scale).cast<float>() + origin - p;
    const float cross = left.cross(right).norm();
    deviation_[i] = cross / ((right - left).norm() + 1e-6f);
    if (deviation_[i] > static_cast<float>(edge_min_deviation_))
      bend_[i] = std::atan2(cross, -left.dot(right));
  }
}

void FeatureExtractor::select_plane_points(std::size_t begin, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    if (deviation_[i] >= 0.0f && deviation_[i] < static_cast<float>(plane_max_deviation_)) {
      features_.planes.push_back(static_cast<std::uint32_t>(begin + i));
    }
  }
}

/// Corners: the sharpest bend of its neighbourhood.
void FeatureExtractor::select_bends(std::size_t begin, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    if (deviation_[i] < static_cast<float>(edge_min_deviation_) ||
        bend_[i] < static_cast<float>(edge_min_angle_)) {
      continue;
    }
    const std::size_t k = half_count_[i];
    const auto from = deviation_.begin() + static_cast<std::ptrdiff_t>(i - std::min(i, k));
    const auto to = deviation_.begin() + static_cast<std::ptrdiff_t>(std::min(count, i + k + 1));
    if (std::max_element(from, to) - deviation_.begin() == static_cast<std::ptrdiff_t>(i)) {
      features_.edges.push_back(static_cast<std::uint32_t>(begin + i));
    }
  }
}

/// Narrow segments that stand in front of what lies on both sides: their middle point.
void FeatureExtractor::select_posts(std::span<const SweepPoint> points, std::size_t begin) {
  for (std::size_t first = 0; first < points.size(); first = segment_end_[first]) {
    const std::size_t end = segment_end_[first];
    if (first == 0 || end == points.size() || end - first < kPostMinPoints) continue;
    const float width = (points[end - 1].position - points[first].position).norm();
    const bool in_front =
        points[first - 1].range > points[first].range && points[end].range > points[end - 1].range;
    if (in_front && width < kPostMaxWidth) {
      features_.edges.push_back(static_cast<std::uint32_t>(begin + (first + end) / 2));
    }
  }
}

}  // namespace fleetmap::odometry
