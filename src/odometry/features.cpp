#include "features.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fleetmap::odometry {
namespace {

constexpr std::size_t kMinNeighbours = 2;
constexpr std::size_t kMaxNeighbours = 12;
/// A jump in range between neighbours that is a break in the surface: an offset plus a share of the range.
constexpr float kBreakOffset = 0.15f;
constexpr float kBreakShare = 0.03f;
constexpr float kPostMaxWidth = 0.4f;
constexpr std::size_t kPostMinPoints = 2;
/// A round post's axis lies so many radii behind the mean of its returns; a square one's likewise.
constexpr float kAxisDepth = std::numbers::pi_v<float> / 4.0f;
/// A post that n rays hit is about n - 0.25 spacings wide: posts are the more the farther they are, so those
/// that are hit by luck outnumber those that are missed by ill luck.
constexpr float kOverCount = 0.25f;
constexpr std::size_t kBorderMinPoints = 5;
constexpr float kBorderMinJump = 0.3f;     ///< m, that the background lies behind a border
constexpr float kBorderMaxAngles = 1.7f;   ///< spacings of rays to the background: more, and rays were lost
constexpr float kBorderMaxStretch = 5.0f;  ///< of the spacing of returns by grazing incidence
constexpr float kBorderEvenness = 0.4f;    ///< of the last two spacings
/// 1 sigma of an edge's place as a share of the spacing of returns.
constexpr float kSpacingShare = 0.3f;

}  // namespace

FeatureExtractor::FeatureExtractor(const LoamConfig& config)
    : half_width_(config.feature_half_width),
      plane_max_deviation_(config.plane_max_deviation),
      lidar_(config.T_base_lidar.translation().cast<float>()) {}

const Features& FeatureExtractor::extract(const Sweep& sweep) {
  features_.edges.clear();
  features_.planes.clear();
  for (std::size_t r = 0; r < sweep.rings(); ++r) {
    const auto points = sweep.ring(r);
    if (!trace(points)) continue;
    select_plane_points(sweep.ring_begin[r], points.size());
  }
  const std::size_t ringless = sweep.rings() == 0 ? 0 : sweep.ring_begin.back();
  // No edges among these: where one beam wanders over a surface, its path ends at edges that are not there.
  for (std::size_t i = ringless; i < sweep.points.size(); ++i) {
    features_.planes.push_back(static_cast<std::uint32_t>(i));
  }
  return features_;
}

/// Measures the points that one beam drew in a row and finds the edges among them. False: too few.
bool FeatureExtractor::trace(std::span<const SweepPoint> points) {
  if (points.size() < 2 * kMinNeighbours + 1) return false;
  find_breaks(points);
  measure(points);
  select_posts(points);
  select_borders(points);
  return true;
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
void FeatureExtractor::measure(std::span<const SweepPoint> points) {
  const std::size_t n = points.size();
  sums_.resize(n + 1);
  sums_[0].setZero();
  const Eigen::Vector3f origin = points[0].position;
  for (std::size_t i = 0; i < n; ++i) sums_[i + 1] = sums_[i] + (points[i].position - origin).cast<double>();
  deviation_.assign(n, -1.0f);
  for (std::size_t i = kMinNeighbours; i + kMinNeighbours < n; ++i) {
    const Eigen::Vector3f& p = points[i].position;
    const float spacing = 0.5f * (points[i + 1].position - points[i - 1].position).norm() + 1e-3f;
    const std::size_t k = std::clamp(static_cast<std::size_t>(static_cast<float>(half_width_) / spacing),
                                     kMinNeighbours, kMaxNeighbours);
    if (i < segment_begin_[i] + k || i + k >= segment_end_[i]) continue;
    const double scale = 1.0 / static_cast<double>(k);
    const Eigen::Vector3f left = ((sums_[i] - sums_[i - k]) * scale).cast<float>() + origin - p;
    const Eigen::Vector3f right = ((sums_[i + k + 1] - sums_[i + 1]) * scale).cast<float>() + origin - p;
    deviation_[i] = left.cross(right).norm() / ((right - left).norm() + 1e-6f);
  }
}

void FeatureExtractor::select_plane_points(std::size_t begin, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    if (deviation_[i] >= 0.0f && deviation_[i] < static_cast<float>(plane_max_deviation_)) {
      features_.planes.push_back(static_cast<std::uint32_t>(begin + i));
    }
  }
}

/// Narrow segments that stand in front of what lies on both sides: their axis.
void FeatureExtractor::select_posts(std::span<const SweepPoint> points) {
  for (std::size_t first = 0; first < points.size(); first = segment_end_[first]) {
    const std::size_t end = segment_end_[first], count = end - first;
    if (first == 0 || end == points.size() || count < kPostMinPoints) continue;
    const float width = (points[end - 1].position - points[first].position).norm();
    const bool in_front =
        points[first - 1].range > points[first].range && points[end].range > points[end - 1].range;
    if (!in_front || width > kPostMaxWidth) continue;
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();
    for (const SweepPoint& p : points.subspan(first, count)) mean += p.position;
    mean /= static_cast<float>(count);
    const float spacing = width / static_cast<float>(count - 1);
    const Eigen::Vector3f ray = (mean - lidar_).normalized();
    // As wide as the post seen from above and from the LiDAR: what the ranges differ by is noise, or the beam
    // crosses the post aslant.
    const Eigen::Vector3f chord = points[end - 1].position - points[first].position;
    const float level = (chord - chord.dot(ray) * ray).head<2>().norm();
    const float radius =
        0.5f * level * (static_cast<float>(count) - kOverCount) / static_cast<float>(count - 1);
    features_.edges.push_back({mean + kAxisDepth * radius * ray,
                               0.5f * (points[first].time + points[end - 1].time), kSpacingShare * spacing});
  }
}

/// Selects borders: the points where a smooth surface ends in front of something farther away.
void FeatureExtractor::select_borders(std::span<const SweepPoint> points) {
  for (std::size_t first = 0; first < points.size(); first = segment_end_[first]) {
    const std::size_t end = segment_end_[first];
    if (end - first < kBorderMinPoints) continue;
    if (first > 0) add_border(points.subspan(first, 3), points[first - 1], 1);
    if (end < points.size()) add_border(points.subspan(end - 3, 3), points[end], -1);
  }
}

/// `points`: the last three, from the border inwards if `inwards` is 1, else towards it.
void FeatureExtractor::add_border(std::span<const SweepPoint> points, const SweepPoint& behind, int inwards) {
  const SweepPoint& last = inwards > 0 ? points[0] : points[2];
  const SweepPoint& inner = points[1];
  const SweepPoint& innermost = inwards > 0 ? points[2] : points[0];
  if (behind.range < last.range + kBorderMinJump) return;
  const Eigen::Vector3f step = last.position - inner.position, before = inner.position - innermost.position;
  const float spacing = step.norm();
  if ((step - before).norm() > kBorderEvenness * spacing) return;
  const Eigen::Vector3f ray = (last.position - lidar_) / last.range;
  const float across = ray.cross(step).norm();  // what of the spacing is due to the angle between the rays
  const float angle = across / last.range;
  const float gap = ray.cross(behind.position - lidar_).norm() / behind.range;
  if (gap > kBorderMaxAngles * angle || spacing > kBorderMaxStretch * across) return;
  features_.edges.push_back({last.position + 0.5f * step, last.time, kSpacingShare * spacing});
}

}  // namespace fleetmap::odometry
