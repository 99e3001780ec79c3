#include "driving/path_progress.hpp"

#include <algorithm>
#include <cmath>

namespace fleetmap::planning {
namespace {

constexpr double kSharp = 0.5;      // rad; flatter bends are driven through
constexpr double kShortest = 0.05;  // m; nearer points are one
constexpr double kWindow = 6.0;     // m ahead in which the robot may be
constexpr double kAbeam = 0.4;      // m along the path; nearer than this a corner counts as passed

}  // namespace

PathProgress::PathProgress(const Polyline& path) {
  for (const Eigen::Vector2d& p : path) {
    if (!p.allFinite()) continue;
    if (points_.empty()) {
      points_.push_back(p);
      at_.push_back(0.0);
    } else if (const double step = (p - points_.back()).norm(); step > kShortest) {
      points_.push_back(p);
      at_.push_back(at_.back() + step);
    }
  }
  for (std::size_t k = 1; k + 1 < points_.size(); ++k) {
    const Eigen::Vector2d in = (points_[k] - points_[k - 1]).normalized();
    const Eigen::Vector2d out = (points_[k + 1] - points_[k]).normalized();
    if (in.dot(out) < std::cos(kSharp)) corners_.push_back(at_[k]);
  }
  if (!at_.empty()) corners_.push_back(at_.back());
}

double PathProgress::next_corner() const {
  const auto next = std::ranges::upper_bound(corners_, along_ + 1e-9);
  return next == corners_.end() ? length() : *next;
}

std::size_t PathProgress::segment(double along) const {
  const auto after = std::ranges::upper_bound(at_, along);
  const auto k = static_cast<std::size_t>(after - at_.begin());
  return std::clamp<std::size_t>(k, 1, points_.size() - 1) - 1;
}

Eigen::Vector2d PathProgress::point(double along) const {
  const std::size_t k = segment(along);
  const double share = std::clamp((along - at_[k]) / (at_[k + 1] - at_[k]), 0.0, 1.0);
  return points_[k] + share * (points_[k + 1] - points_[k]);
}

Eigen::Vector2d PathProgress::tangent(double along) const {
  const std::size_t k = segment(along);
  return (points_[k + 1] - points_[k]).normalized();
}

void PathProgress::advance(const Eigen::Vector2d& p, double tolerance, double abeam) {
  if (empty()) return;
  for (std::size_t guard = 0; guard <= corners_.size(); ++guard) {
    const double corner = next_corner();
    const double limit = std::min(corner, along_ + kWindow);
    double best = along_;
    double nearest = (point(along_) - p).squaredNorm();
    for (std::size_t k = segment(along_); k + 1 < points_.size() && at_[k] < limit; ++k) {
      const Eigen::Vector2d d = points_[k + 1] - points_[k];
      const double on = at_[k] + (p - points_[k]).dot(d.normalized());
      const double here = std::clamp(on, std::max(along_, at_[k]), std::min(limit, at_[k + 1]));
      const double distance = (point(here) - p).squaredNorm();
      if (distance < nearest) {
        nearest = distance;
        best = here;
      }
    }
    along_ = best;
    const double away = (point(corner) - p).norm();
    const bool passed = corner - along_ < kAbeam && away <= abeam;
    if (corner >= length() || !(passed || away < tolerance)) {
      // A corner abeam but too far to the side stays ahead.
      if (corner < length() && corner - along_ < 1e-6) along_ = std::max(0.0, corner - 1e-3);
      return;
    }
    along_ = corner;
  }
}

}  // namespace fleetmap::planning
