#include "delay_window.hpp"

#include <algorithm>
#include <cmath>

namespace fleetmap::exchange {
namespace {

// A queue shorter than the target overflows before LEDBAT reacts. The target is therefore set to 0.7 of the
// queueing delay at the loss and recovers by 0.5 % a round trip.
constexpr double kBelowOverflow = 0.7;
constexpr double kRecovery = 0.005;
/// s. A loss while chunks waited less was not made by a queue: so much the ticks of both ends make.
constexpr double kQueueLoss = 0.035;
constexpr double kAfterQueueLoss = 0.5, kAfterOtherLoss = 0.9;  // what is left of the window
/// The least delay is that of the last one to two of these: a path may become slower for good.
constexpr Duration kBaseHistory = std::chrono::minutes(1);

}  // namespace

double BaseDelay::queueing_of(double delay_s, Stamp now) {
  if (!begun_ || now - *begun_ > kBaseHistory) {
    before_ = recent_;
    recent_ = delay_s;
    begun_ = now;
  }
  recent_ = std::min(recent_, delay_s);
  return delay_s - std::min(recent_, before_);
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
  window_ = std::clamp<double>(window_, config_.min_bytes, config_.max_bytes);
  target_ = std::min(target_ * (1.0 + kRecovery * rounds), config_.target_s);
}

bool DelayWindow::queues() const { return queueing_ > kQueueLoss; }

void DelayWindow::on_loss(Stamp asked, Stamp now) {
  slow_start_ = false;
  if (halved_ && asked <= *halved_) return;  // sent before the window was halved
  halved_ = now;
  const bool overflowed = queues();
  window_ = std::max<double>(window_ * (overflowed ? kAfterQueueLoss : kAfterOtherLoss), config_.min_bytes);
  if (overflowed) target_ = std::clamp(kBelowOverflow * queueing_, DelayWindowConfig::kMinTarget, target_);
}

}  // namespace fleetmap::exchange
