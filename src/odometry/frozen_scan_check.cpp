#include "frozen_scan_check.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace fleetmap::odometry {
namespace {

constexpr std::size_t kComparedPoints = 500;  // spread evenly over the scan

}  // namespace

bool FrozenScanCheck::frozen(const sensor::Scan& scan, bool robot_moves) {
  const std::size_t stride = std::max<std::size_t>(1, scan.points.size() / kComparedPoints);
  std::vector<std::uint32_t> coordinates;  // compared bit by bit, so that NaN equals NaN
  for (std::size_t k = 0; k < scan.points.size(); k += stride) {
    for (const float x : scan.points[k].position) coordinates.push_back(std::bit_cast<std::uint32_t>(x));
  }
  if (coordinates.empty() || scan.points.size() != compared_of_ || coordinates != compared_) {
    compared_ = std::move(coordinates);
    compared_of_ = scan.points.size();
    repeated_before_ = std::exchange(repeated_in_a_row_, 0);
    frozen_ = false;
    return false;
  }
  ++repeated_in_a_row_;
  frozen_ = frozen_ || robot_moves;
  return frozen_;
}

}  // namespace fleetmap::odometry
