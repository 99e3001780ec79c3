#include "fleetmap/exchange/delay_window.hpp"

#include <algorithm>
#include <cmath>

namespace fleetmap::exchange {
namespace {

// A queue shorter than the target overflows before LEDBAT reacts. The target is therefore set to 0.7 of the
// queueing delay at the loss and recovers by 0.5 % a round trip.
constexpr double kBelowOverflow = 0.7;
constexpr double kLeastTarget = 0.05;  // s: two ticks of both ends and some
constexpr double kRecovery = 0.005;
/// s. A loss while chunks waited less was not made by a queue: so much the ticks of both ends make.
constexpr double kQueueLoss = 0.035;
constexpr double kAfterQueueLoss = 0.5, kAfterOtherLoss = 0.9;  // what is left of the window
/// The least delay is that of the last one to two of these: a path may become slower for good.
constexpr Duration kBaseHistory = std::chrono::minutes(1);

}  // namespace

double LeastDelay::queueing_of(double delay_s, Stamp now) {
  if (!begun_ || now - *begun_ > kBaseHistory) {
    before_ = recent_;
    recent_ = delay_s;
    begun_ = now;
  }
  recent_ = std::min(recent_, delay_s);
  return delay_s - std::min(recent_, before_);
}

Status DelayWindowConfig::validate() const {
  if (!(target_s >= kLeastTarget) || !std::isfinite(target_s))
    return failure("submap_transfer.window.target_s must be at least 0.05");
  if (step_bytes == 0 || least_bytes < step_bytes || first_bytes < least_bytes || most_bytes < first_bytes) {
    return failure(
        "short_range.window_bytes must be at least " + std::to_string(first_bytes) +
        ", and submap_transfer.window's step_bytes, least_bytes and first_bytes must not decrease");
  }
  return {};
}

DelayWindow::DelayWindow(const DelayWindowConfig& config)
    : config_(config), window_(config.first_bytes), target_(config.target_s) {}

void DelayWindow::on_arrival(double queueing_s, std::uint32_t bytes) {
  const double rounds = bytes / window_;
  queueing_ += std::min(rounds, 1.0) * (queueing_s - queueing_);
  const double off_target = 1.0 - queueing_s / target_;
  // It ends before the queue is full: what is under way then still has to fit.
  if (off_target < 0.5) slow_start_ = false;
  window_ += slow_start_ ? bytes : std::max(off_target, -1.0) * rounds * config_.step_bytes;
  window_ = std::clamp<double>(window_, config_.least_bytes, config_.most_bytes);
  target_ = std::min(target_ * (1.0 + kRecovery * rounds), config_.target_s);
}

bool DelayWindow::queues() const { return queueing_ > kQueueLoss; }

void DelayWindow::on_loss(Stamp asked, Stamp now) {
  slow_start_ = false;
  if (halved_ && asked <= *halved_) return;  // sent before the window was halved
  halved_ = now;
  const bool overflowed = queues();
  window_ = std::max<double>(window_ * (overflowed ? kAfterQueueLoss : kAfterOtherLoss), config_.least_bytes);
  if (overflowed) target_ = std::clamp(kBelowOverflow * queueing_, kLeastTarget, target_);
}

}  // namespace fleetmap::exchange
