#include "fleetmap/localization/heading_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fleetmap::localization {
namespace {

constexpr std::size_t kMinMatches = 5;
constexpr double kMinSpacing = 0.5;           ///< m
constexpr double kMinBaseline = 2.0;          ///< m
constexpr double kDeadReckoningSigma = 0.03;  ///< rad, of the track's own curvature

}  // namespace

void HeadingAlignment::advance(double distance, double yaw) {
  position_ += distance * Eigen::Vector2d(std::cos(yaw), std::sin(yaw));
  travelled_ += std::abs(distance);
}

bool HeadingAlignment::add_fix(const Eigen::Vector2d& p_enu, double sigma,
                               const Eigen::Vector2d& antenna_offset) {
  // Spaced so that the whole window spans a dozen standard deviations.
  if (count_ > 0 && travelled_ < std::max(kMinSpacing, 0.5 * sigma)) return false;
  push({p_enu, position_ + antenna_offset, sigma});
  return true;
}

bool HeadingAlignment::add_fix_without_odometer(const Eigen::Vector2d& p_enu, double sigma, double yaw) {
  if (count_ > 0) {
    const Eigen::Vector2d step = p_enu - matches_[(next_ + kCapacity - 1) % kCapacity].gps;
    // Steps must exceed the noise, or a robot at rest would appear to drive.
    if (step.norm() < std::max(2.0, 4.0 * sigma)) return false;
    const double turn = std::remainder(yaw - last_yaw_, 2.0 * std::numbers::pi);
    advance(step.norm(), last_yaw_ + 0.5 * turn);
  }
  last_yaw_ = yaw;
  push({p_enu, position_, sigma});
  return true;
}

void HeadingAlignment::push(const Match& match) {
  matches_[next_] = match;
  next_ = (next_ + 1) % kCapacity;
  count_ = std::min(count_ + 1, kCapacity);
  travelled_ = 0.0;
}

std::optional<HeadingAlignment::Estimate> HeadingAlignment::estimate() const {
  if (count_ < kMinMatches) return std::nullopt;
  const auto n = static_cast<double>(count_);
  Eigen::Vector2d gps_mean = Eigen::Vector2d::Zero();
  Eigen::Vector2d reckoned_mean = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < count_; ++i) {
    gps_mean += matches_[i].gps / n;
    reckoned_mean += matches_[i].reckoned / n;
  }
  double dot = 0.0, cross = 0.0, gps2 = 0.0, reckoned2 = 0.0, sigma = 0.0;
  for (std::size_t i = 0; i < count_; ++i) {
    const Eigen::Vector2d g = matches_[i].gps - gps_mean;
    const Eigen::Vector2d r = matches_[i].reckoned - reckoned_mean;
    dot += r.dot(g);
    cross += r.x() * g.y() - r.y() * g.x();
    gps2 += g.squaredNorm();
    reckoned2 += r.squaredNorm();
    sigma = std::max(sigma, matches_[i].sigma);
  }
  // Root mean square spread times three is close to the length of a straight track.
  const double baseline = 3.0 * std::sqrt(reckoned2 / n);
  if (baseline < kMinBaseline) return std::nullopt;
  const double residual2 = std::max(0.0, gps2 + reckoned2 - 2.0 * std::hypot(dot, cross)) / n;
  const double residual = std::sqrt(residual2);
  if (residual > 3.0 * sigma + 0.1 * baseline) return std::nullopt;
  const double spread = std::max(sigma, residual);
  return Estimate{std::atan2(cross, dot),
                  std::hypot(std::numbers::sqrt2 * spread / baseline, kDeadReckoningSigma)};
}

void HeadingAlignment::clear() { *this = HeadingAlignment(); }

}  // namespace fleetmap::localization
