#include "model_check.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fleetmap::odometry {
namespace {

constexpr std::uint64_t kEvery = 10;  // scans
constexpr int kSure = 3;              // scans that agree, and more than half
constexpr std::size_t kStride = 16;   // points, of which the elevation is measured
constexpr std::size_t kMinPoints = 100;
constexpr float kMinRange = 0.5f;  // m
/// Points that lie evenly between the rings scatter by 0.29 of their spacing, those of a device by
/// hundredths.
constexpr double kMaxScatter = 0.2;
constexpr double kMaxBeyond = 0.1;    // share of the points above and below all rings
constexpr double kAgainst = 0.8;      // share of the pairs of points
constexpr double kAgainstAll = 0.98;  // the same, if no rotation gives better evidence
constexpr std::size_t kPairs = 2000;  // of points, whose times are compared

constexpr const char* kBackwards =
    "the times of the points fall in the order of the points, against the sense in which the LiDAR turns: "
    "the motion compensation bends the scans; mend the time field of the driver (it must grow from the "
    "first point to the last), or set odometry.deskew to false";

constexpr const char* kMillimetres =
    "LiDAR: half of its points are more than 1 km away, so they are in millimetres and not in metres; scale "
    "x, y and z "
    "in the driver by 0.001";

std::string wrong_rings(const LidarModel& model) {
  std::string text = "lidar.model '";
  text += model.name;
  text += "' does not fit: points lie between and beyond its ";
  text += std::to_string(model.vertical_angles.size());
  text +=
      " rings, so their times and the motion compensation are wrong; set lidar.model to that of the device "
      "or to generic, or lidar.elevations_deg";
  return text;
}

bool usable(const Eigen::Vector3f& p) { return p.allFinite() && p.squaredNorm() > kMinRange * kMinRange; }

}  // namespace

bool ModelCheck::Finding::add(bool found) {
  ++of;
  scans += found;
  return found && scans == kSure && 2 * scans > of;
}

ModelCheck::ModelCheck(LidarModel model) : model_(std::move(model)), angles_(model_.vertical_angles) {
  std::ranges::sort(angles_);
  if (angles_.size() > 1)
    spacing_ = (angles_.back() - angles_.front()) / static_cast<double>(angles_.size() - 1);
}

void ModelCheck::add(const sensor::Scan& scan) {
  if (scans_++ % kEvery != 0) return;
  if (rings_.add(rings_differ(scan))) news_.push_back(wrong_rings(model_));
  if (times_.add(times_run_backwards(scan))) news_.emplace_back(kBackwards);
  if (units_.add(in_millimetres(scan))) news_.emplace_back(kMillimetres);
}

std::vector<std::string> ModelCheck::take_warnings() { return std::exchange(news_, {}); }

bool ModelCheck::in_millimetres(const sensor::Scan& scan) {
  constexpr float kFar = 1000.0f;  // m
  const auto far = std::ranges::count_if(
      scan.points, [](const sensor::ScanPoint& point) { return point.position.squaredNorm() > kFar * kFar; });
  return scan.points.size() >= kMinPoints && 2 * static_cast<std::size_t>(far) > scan.points.size();
}

bool ModelCheck::rings_differ(const sensor::Scan& scan) const {
  if (scan.has_ring || angles_.size() < 2) return false;
  struct Moments {
    double n = 0, sum = 0, square = 0;
  };
  std::vector<Moments> rings(angles_.size());
  std::size_t points = 0, beyond = 0;
  for (std::size_t i = 0; i < scan.points.size(); i += kStride) {
    const Eigen::Vector3f& p = scan.points[i].position;
    if (!usable(p)) continue;
    ++points;
    const double elevation = std::atan2(p.z(), std::hypot(p.x(), p.y()));
    const auto above = std::ranges::lower_bound(angles_, elevation);
    const auto nearest =
        above == angles_.end() || (above != angles_.begin() && elevation - above[-1] < *above - elevation)
            ? above - 1
            : above;
    const double off = elevation - *nearest;
    beyond += std::abs(off) > spacing_;
    if (std::abs(off) > spacing_) continue;
    Moments& ring = rings[static_cast<std::size_t>(nearest - angles_.begin())];
    ring.n += 1, ring.sum += off, ring.square += off * off;
  }
  if (points < kMinPoints) return false;
  if (static_cast<double>(beyond) > kMaxBeyond * static_cast<double>(points)) return true;
  // Rings that come in the order of the points need no table, and a device's own need not be at these angles.
  if (model_.ring_source != RingSource::kElevation) return false;
  double square = 0.0, n = 0.0;
  for (const Moments& ring : rings) {
    if (ring.n < 2) continue;
    square += ring.square - ring.sum * ring.sum / ring.n;
    n += ring.n - 1;
  }
  return n > 0.0 && std::sqrt(square / n) > kMaxScatter * spacing_;
}

/// Against the order of the points and, where they come in rings, against the sense of rotation of the
/// device: a cloud may be stored from its end, and a device may hang upside down.
bool ModelCheck::times_run_backwards(const sensor::Scan& scan) const {
  if (!scan.has_time || scan.points.size() < kMinPoints) return false;
  // Neighbours in firing order share a time.
  const std::size_t apart = std::max<std::size_t>(1, scan.points.size() / 100);
  const std::size_t step = std::max<std::size_t>(1, scan.points.size() / kPairs);
  double pairs = 0.0, falls = 0.0, turns = 0.0, against = 0.0;
  for (std::size_t i = 0; i + apart < scan.points.size(); i += step) {
    const sensor::ScanPoint &a = scan.points[i], &b = scan.points[i + apart];
    if (!usable(a.position) || !usable(b.position) || !std::isfinite(a.time) || !std::isfinite(b.time) ||
        a.time == b.time)
      continue;
    ++pairs;
    falls += b.time < a.time;
    if (a.position.head<2>().dot(b.position.head<2>()) <= 0.0f) continue;
    const float left = a.position.x() * b.position.y() - a.position.y() * b.position.x();
    ++turns;
    against += (left > 0.0f) == (b.time > a.time) ? model_.clockwise : !model_.clockwise;
  }
  if (pairs < static_cast<double>(kMinPoints)) return false;
  const bool spins = model_.has_rings() || scan.has_ring;
  return spins ? falls > kAgainst * pairs && against > kAgainst * turns : falls > kAgainstAll * pairs;
}

}  // namespace fleetmap::odometry
