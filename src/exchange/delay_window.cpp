#include "fleetmap/exchange/delay_window.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fleetmap::exchange {
namespace {

// A queue that is shorter than the target overflows again and again, and LEDBAT would live on losses. So the
// target stays below the delay at which it last overflowed, and comes back slowly, since queues and their
// other users change.
constexpr double kBelowOverflow = 0.7;
constexpr double kLeastTarget = 0.02;  // s
constexpr double kRecovery = 0.005;    // a round trip

}  // namespace

Status DelayWindowConfig::validate() const {
  if (!(target_s > 0.0) || !std::isfinite(target_s))
    return failure("submap_transfer.window.target_s must be positive");
  if (step_bytes == 0 || least_bytes < step_bytes || first_bytes < least_bytes || most_bytes < first_bytes) {
    return failure(
        "submap_transfer.window: step_bytes, least_bytes, first_bytes and most_bytes must not decrease");
  }
  return {};
}

DelayWindow::DelayWindow(const DelayWindowConfig& config)
    : config_(config),
      window_(config.first_bytes),
      least_delay_(std::numeric_limits<double>::infinity()),
      target_(config.target_s) {}

void DelayWindow::on_arrival(double delay_s, std::uint32_t bytes) {
  least_delay_ = std::min(least_delay_, delay_s);
  const double queueing = delay_s - least_delay_;
  const double rounds = bytes / window_;
  queueing_ += std::min(rounds, 1.0) * (queueing - queueing_);
  const double off_target = 1.0 - queueing / target_;
  // It ends before the queue is full: what is under way then still has to fit.
  if (off_target < 0.5) slow_start_ = false;
  window_ += slow_start_ ? bytes : std::max(off_target, -1.0) * rounds * config_.step_bytes;
  window_ = std::clamp<double>(window_, config_.least_bytes, config_.most_bytes);
  target_ = std::min(target_ * (1.0 + kRecovery * rounds), config_.target_s);
}

void DelayWindow::on_loss(Stamp asked, Stamp now) {
  slow_start_ = false;
  if (halved_ && asked <= *halved_) return;  // sent before the window was halved
  halved_ = now;
  window_ = std::max<double>(window_ / 2.0, config_.least_bytes);
  target_ = std::clamp(kBelowOverflow * queueing_, kLeastTarget, target_);
}

}  // namespace fleetmap::exchange
