#include "fleetmap/odometry/trajectory_check.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iomanip>
#include <numbers>
#include <sstream>

namespace fleetmap::odometry {
namespace {

/// A trajectory of which more than this share is prediction is no measurement.
constexpr double kMaxLost = 0.01;
/// Nor is a part of it that has more than this share of some seconds, and more than a scan or two.
constexpr double kMaxLostInAWhile = 0.05;
constexpr Duration kWhile = std::chrono::seconds(10);
constexpr std::size_t kFewLost = 2;
/// m, and share of the length: an end that is stated less well than by both may be anywhere.
constexpr double kVague = 1.0, kVagueShare = 0.05;
/// m of way, each of which must be stated to a tenth, 1 sigma in m and in rad times length.
constexpr double kStretch = 20.0, kVagueStretch = 2.0, kTurned = 0.2;

double translation_sigma(const Matrix6d& C) { return std::sqrt(C.topLeftCorner<3, 3>().trace()); }
double rotation_sigma(const Matrix6d& C) { return std::sqrt(C.bottomRightCorner<3, 3>().trace()); }

}  // namespace

void TrajectoryCheck::add(const OdometryUpdate& update) {
  if (updates_++ == 0)
    first_ = update.stamp;
  else
    length_ += (last_.inverse() * update.T_odom_base).translation().norm();
  last_ = update.T_odom_base;
  lost_ += update.lost;
  whole_.add(update);
  update_losses(update);
  update_stretch(update);
}

void TrajectoryCheck::update_losses(const OdometryUpdate& update) {
  recent_.push_back({update.stamp, update.lost});
  recent_lost_ += update.lost;
  while (update.stamp - recent_.front().stamp >= kWhile || update.stamp < recent_.front().stamp) {
    recent_lost_ -= recent_.front().lost;
    recent_.pop_front();
  }
  if (recent_lost_ <= kFewLost) return;
  const double share = static_cast<double>(recent_lost_) / static_cast<double>(recent_.size());
  if (share > losses_.value) losses_ = {share, update.stamp};
}

void TrajectoryCheck::update_stretch(const OdometryUpdate& update) {
  stretch_.add(update);
  if (length_ - stretch_begin_ < kStretch) return;
  const Matrix6d C = stretch_.since_reference();
  if (const double sigma = translation_sigma(C); sigma > vague_.value) vague_ = {sigma, update.stamp};
  if (const double sigma = rotation_sigma(C); sigma > turned_.value) turned_ = {sigma, update.stamp};
  stretch_.restart();
  stretch_begin_ = length_;
}

std::string TrajectoryCheck::after_start(Stamp stamp) const {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << to_seconds(stamp - first_) << " s after the start";
  return text.str();
}

std::vector<std::string> TrajectoryCheck::warnings() const {
  std::vector<std::string> warnings;
  const auto warn = [&](const auto&... parts) {
    std::ostringstream text;
    text << std::fixed << std::setprecision(2);
    (text << ... << parts);
    warnings.push_back(text.str());
  };
  const auto share = static_cast<double>(lost_) / static_cast<double>(std::max<std::size_t>(1, updates_));
  if (share > kMaxLost) warn(100.0 * share, " % of all scans are lost");
  if (losses_.value > kMaxLostInAWhile)
    warn(100.0 * losses_.value, " % of the scans of 10 s are lost, ", after_start(losses_.at));
  const double sigma = translation_sigma(covariance());
  if (sigma > std::max(kVague, kVagueShare * length_)) warn("the end is stated to ", sigma, " m only");
  if (vague_.value > kVagueStretch)
    warn("20 m of the way are stated to ", vague_.value, " m only, ", after_start(vague_.at));
  if (turned_.value > kTurned)
    warn("the heading over 20 m of the way is stated to ", turned_.value * 180.0 / std::numbers::pi,
         " deg only, ", after_start(turned_.at));
  return warnings;
}

}  // namespace fleetmap::odometry
