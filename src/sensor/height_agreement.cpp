#include "fleetmap/sensor/height_agreement.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "fleetmap/core/utc.hpp"
#include "short_number.hpp"

namespace fleetmap::sensor {
namespace {

constexpr std::size_t kHeightsBefore = 5, kMinHeightsAfter = 2;
// Shorter than the EKF rejects fixes that contradict it, longer than most reflections.
constexpr Duration kStepLasts = std::chrono::seconds(5);
constexpr std::size_t kMaxHeightsAfter = 200;
constexpr double kMinStep = 10.0;  // m; the height of a consumer receiver wanders by 3 to 5 m
constexpr double kStepSigmas = 5.0;
/// Slope of the odometry's frame, as a share of the way: it is level only if the robot started level or has
/// an IMU.
constexpr double kFrameSlope = 0.2;
/// m without a fix, after which slope and drift of the odometry may be taken for a step.
constexpr double kMaxWayBetween = 20.0;
/// A height that is nearer to the first one than this share of a step has returned to it.
constexpr double kReturned = 0.5;

/// m, of GPS above the odometry.
double median_offset(const std::deque<HeightAgreement::Height>& heights) {
  std::vector<double> offsets;
  for (const HeightAgreement::Height& height : heights) offsets.push_back(height.gps - height.odom.z());
  const auto half = offsets.begin() + static_cast<std::ptrdiff_t>(offsets.size() / 2);
  std::ranges::nth_element(offsets, half);
  return *half;
}

}  // namespace

void HeightAgreement::interrupt() {
  begin_anew();
  first_level_.reset();
}

void HeightAgreement::begin_anew() {
  before_.clear();
  after_.clear();
  anew_ = true;
}

void HeightAgreement::add(const Height& height) {
  if (!first_) first_ = height.stamp;
  const std::optional<double> last = std::exchange(last_gps_, height.gps);
  if (!before_.empty() && after_.empty() && (height.odom - before_.back().odom).norm() > kMaxWayBetween)
    begin_anew();
  // The step may have ended in the meantime.
  if (std::exchange(anew_, false) && last &&
      std::abs(height.gps - *last + correction_) < kReturned * std::abs(correction_))
    correction_ = 0.0;
  const auto agree = [&] {
    after_.clear();
    before_.push_back(height);
    if (before_.size() > kHeightsBefore) before_.pop_front();
    if (before_.size() == kHeightsBefore && !first_level_)
      first_level_ = median_offset(before_) - correction_;
  };
  if (before_.size() < kHeightsBefore) return agree();
  const double offset = height.gps - height.odom.z(), reference = median_offset(before_);
  const double moved = (height.odom - before_.front().odom).norm();
  const double bound =
      std::max(kMinStep, kStepSigmas * std::hypot(height.sigma, before_.back().sigma)) + kFrameSlope * moved;
  if (std::abs(offset - reference) < bound) return agree();
  if (!after_.empty() && std::abs(offset - median_offset(after_)) > 0.5 * bound) after_.clear();
  after_.push_back(height);
  if (after_.size() > kMaxHeightsAfter) after_.pop_front();
  if (after_.size() < kMinHeightsAfter || height.stamp - after_.front().stamp < kStepLasts) return;
  // The first ones after it, since the error of GPS wanders.
  const auto near = std::min(kHeightsBefore, after_.size());
  begin_after(reference,
              median_offset({after_.begin(), std::next(after_.begin(), static_cast<std::ptrdiff_t>(near))}));
}

void HeightAgreement::begin_after(double level_before, double level) {
  const double step = level - level_before;
  // An error that grew slowly ends at once: heights are right again.
  const bool returned = std::abs(level - *first_level_) < kReturned * std::abs(step);
  correction_ = returned ? 0.0 : correction_ + step;
  const Height& first = after_.front();
  if (!std::exchange(reported_, true))
    finding_ = "GPS: its height jumped by " + short_number(step) + " m at " + to_utc(first.stamp) + " (" +
               short_number(to_seconds(first.stamp - *first_)) +
               " s after the first fix) while the robot's changed by " +
               short_number(first.odom.z() - before_.back().odom.z()) +
               " m: RTK was lost, the base station changed, or heights are above sea level instead of the "
               "ellipsoid. " +
               std::string(returned ? "They are as the first ones again, and used as they are"
                                    : "Later heights are corrected by this jump and by further ones") +
               ". Check the receiver's corrections and the datum of its heights";
  before_ = std::exchange(after_, {});
  while (before_.size() > kHeightsBefore) before_.pop_front();
}

std::optional<std::string> HeightAgreement::take_finding() { return std::exchange(finding_, std::nullopt); }

}  // namespace fleetmap::sensor
