#include "loss_check.hpp"

namespace fleetmap::odometry {
namespace {

constexpr double kMinUpright = 60.0;   // upright features that a decision needs
constexpr double kMissingBelow = 0.2;  // share of the usual upright inliers
constexpr double kUprightGain = 0.2;   // smooths over half a second

}  // namespace

bool LossCheck::lost(const MatchResult& match) {
  const auto matched = static_cast<int>(match.planes + match.edges);
  return matched < min_matches_ || match.inlier_fraction < min_inlier_fraction_ || misses_upright(match);
}

bool LossCheck::misses_upright(const MatchResult& match) {
  const auto upright = static_cast<double>(match.upright);
  const auto inliers = static_cast<double>(match.upright_inliers);
  const bool few = usual_upright_ > kMinUpright && inliers < kMissingBelow * usual_upright_;
  const bool unfit = upright > kMinUpright && inliers < min_inlier_fraction_ * upright;
  if (few || unfit) return true;
  usual_upright_ += kUprightGain * (inliers - usual_upright_);
  return false;
}

}  // namespace fleetmap::odometry
