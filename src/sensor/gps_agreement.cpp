#include "fleetmap/sensor/gps_agreement.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <utility>

#include "short_number.hpp"

namespace fleetmap::sensor {
namespace {

constexpr std::size_t kMaxFixesWaiting = 100;
constexpr double kUnknownSigma = 3.0, kUnknownVerticalSigma = 4.0;  // m
constexpr double kMinJump = 10.0;  // m, more than its error changes from fix to fix
constexpr double kSigmas = 5.0;
constexpr double kSpacing = 2.0;  // m between places of the track
constexpr std::size_t kMinTrack = 10, kMaxTrack = 100;
constexpr double kCheckedEvery = 5.0;  // m
constexpr double kMinMisfit = 3.0;     // m
constexpr double kMisfitSigmas = 2.0;
constexpr double kSameSize = 1.4;
constexpr double kMirroredFits = 0.5;  // of the misfit without mirroring
constexpr double kMinWidth = 0.15;     // of the track's length: a straight line is its own mirror image
constexpr int kContradictions = 2;

double sigma_of(const Fix& fix) {
  const double variance = 0.5 * (fix.covariance(0, 0) + fix.covariance(1, 1));
  return std::isfinite(variance) && variance > 0.0 ? std::sqrt(variance) : kUnknownSigma;
}

double vertical_sigma_of(const Fix& fix) {
  const double variance = fix.covariance(2, 2);
  return std::isfinite(variance) && variance > 0.0 ? std::sqrt(variance) : kUnknownVerticalSigma;
}

/// Misfits of two tracks.
struct Fit {
  double rotated;                  ///< m, RMS after the best rotation and shift
  double rotated_sized, mirrored;  ///< the same of tracks that are brought to one size, and of a mirrored one
  double size;                     ///< that of GPS over that of the odometry
  double width;                    ///< over the length, of the odometry's track
};

/// After Umeyama, Least-squares estimation of transformation parameters (PAMI 1991), in two dimensions.
Fit fit_of(const Eigen::Matrix2Xd& gps, const Eigen::Matrix2Xd& odom) {
  const Eigen::Matrix2Xd a = gps.colwise() - gps.rowwise().mean(), b = odom.colwise() - odom.rowwise().mean();
  const Eigen::Matrix2d products = a * b.transpose();
  const Eigen::Vector2d singular = Eigen::JacobiSVD<Eigen::Matrix2d>(products).singularValues();
  const Eigen::Vector2d extent = Eigen::JacobiSVD<Eigen::Matrix2d>(b * b.transpose()).singularValues();
  const double gps_squares = a.squaredNorm(), odom_squares = std::max(b.squaredNorm(), 1e-9);
  const double size = std::sqrt(gps_squares / odom_squares);
  const auto misfit = [&](double trace, double scale) {
    const double squares = gps_squares + scale * scale * odom_squares - 2.0 * scale * trace;
    return std::sqrt(std::max(0.0, squares) / static_cast<double>(a.cols()));
  };
  const double sum = singular.sum(), difference = singular(0) - singular(1);
  const bool mirrors = products.determinant() < 0.0;
  return {misfit(mirrors ? difference : sum, 1.0), misfit(mirrors ? difference : sum, size),
          misfit(mirrors ? sum : difference, size), size, std::sqrt(extent(1) / std::max(extent(0), 1e-9))};
}

}  // namespace

void GpsAgreement::interrupt() {
  last_.reset();
  heights_.interrupt();
  last_matched_.reset();
  track_.clear();
  waiting_.clear();
}

void GpsAgreement::add(const Fix& fix) {
  if (!fix.valid || !is_valid(fix.position)) return;
  waiting_.push_back(fix);
  if (waiting_.size() > kMaxFixesWaiting) waiting_.pop_front();
}

void GpsAgreement::add_motion(Stamp stamp, const Pose& T_odom_base) {
  const Instant now{stamp, T_odom_base.translation()};
  const std::optional<Instant> before = std::exchange(last_, now);
  while (!waiting_.empty() && waiting_.front().stamp <= stamp) {
    const Fix fix = waiting_.front();
    waiting_.pop_front();
    if (!before || fix.stamp < before->stamp) continue;
    const double share = to_seconds(fix.stamp - before->stamp) / to_seconds(stamp - before->stamp);
    match(fix, before->odom + share * (now.odom - before->odom));
  }
}

void GpsAgreement::match(const Fix& fix, const Eigen::Vector3d& odom) {
  if (!frame_) frame_.emplace(fix.position);
  const MatchedFix matched{frame_->to_enu(fix.position).head<2>(), odom.head<2>(), sigma_of(fix)};
  heights_.add({fix.stamp, fix.position.altitude, vertical_sigma_of(fix), odom});
  if (auto finding = heights_.take_finding()) findings_.push_back(std::move(*finding));
  check_jump(matched);
  last_matched_ = matched;
  const double step = track_.empty() ? kSpacing : (matched.odom - track_.back().odom).norm();
  if (step < kSpacing) return;
  track_.push_back(matched);
  if (track_.size() > kMaxTrack) track_.pop_front();
  driven_ += step;
  if (driven_ < kCheckedEvery || track_.size() < kMinTrack) return;
  driven_ = 0.0;
  check_track();
}

void GpsAgreement::check_jump(const MatchedFix& matched) {
  if (!last_matched_ || jump_reported_) return;
  const double moved = (matched.odom - last_matched_->odom).norm();
  const double jump = (matched.gps - last_matched_->gps).norm() - moved;
  if (jump < std::max(kMinJump, kSigmas * (matched.sigma + last_matched_->sigma))) return;
  jump_reported_ = true;
  findings_.push_back("GPS: it jumped by " + short_number(jump) + " m while the robot moved " +
                      short_number(moved) +
                      " m: reflections, a changed base station, or another receiver on the topic. Fixes that "
                      "contradict the motion are not used; check the antenna and its surroundings");
}

void GpsAgreement::check_track() {
  if (track_reported_) return;
  const auto count = static_cast<Eigen::Index>(track_.size());
  Eigen::Matrix2Xd gps(2, count), odom(2, count);
  double sigma = 0.0;
  for (Eigen::Index k = 0; k < count; ++k) {
    const MatchedFix& matched = track_[static_cast<std::size_t>(k)];
    gps.col(k) = matched.gps;
    odom.col(k) = matched.odom;
    sigma = std::max(sigma, matched.sigma);
  }
  const Fit fit = fit_of(gps, odom);
  contradictions_ = fit.rotated > std::max(kMinMisfit, kMisfitSigmas * sigma) ? contradictions_ + 1 : 0;
  if (contradictions_ < kContradictions) return;
  track_reported_ = true;
  std::string why = "it is of another robot or time, or the position is wrong";
  if (fit.width > kMinWidth && fit.mirrored < kMirroredFits * fit.rotated_sized) {
    why = "it is mirrored: latitude and longitude are swapped, or one of them has the wrong sign";
  } else if (fit.size > kSameSize || fit.size < 1.0 / kSameSize) {
    why = "it is " + short_number(fit.size) +
          " times as large: latitude and longitude are swapped, or their unit is not the degree";
  }
  findings_.push_back("GPS: its track misses the way that was driven by " + short_number(fit.rotated) +
                      " m: " + why +
                      ". The map's place on the Earth is wrong; correct the driver or leave the topic away");
}

std::vector<std::string> GpsAgreement::take_findings() { return std::exchange(findings_, {}); }

}  // namespace fleetmap::sensor
