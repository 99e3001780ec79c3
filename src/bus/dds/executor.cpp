#include "executor.hpp"

#include <algorithm>
#include <utility>

namespace fleetmap::bus {

void Executor::post(Work callback) {
  {
    const std::scoped_lock lock(mutex_);
    posted_.push_back(std::move(callback));
  }
  changed_.notify_one();
}

bool Executor::try_post(Work callback) {
  {
    const std::scoped_lock lock(mutex_);
    if (posted_.size() >= kMaxPosted) return false;
    posted_.push_back(std::move(callback));
  }
  changed_.notify_one();
  return true;
}

void Executor::wake() {
  {
    const std::scoped_lock lock(mutex_);
    woken_ = true;
  }
  changed_.notify_one();
}

void Executor::stop() {
  {
    const std::scoped_lock lock(mutex_);
    stopped_ = true;
  }
  changed_.notify_one();
}

bool Executor::stopped() const {
  const std::scoped_lock lock(mutex_);
  return stopped_;
}

std::function<void()> Executor::add_timer(Duration period, Work callback) {
  auto timer = std::make_shared<Timer>(Timer{period, std::move(callback)});
  {
    const std::scoped_lock lock(mutex_);
    timers_.emplace(Clock::now() + period, timer);
  }
  changed_.notify_one();
  return [timer = std::weak_ptr<Timer>(timer)] {
    if (const auto alive = timer.lock()) alive->active = false;
  };
}

std::optional<Work> Executor::take_timer(Clock::time_point now) {
  while (!timers_.empty() && timers_.begin()->first <= now) {
    auto entry = timers_.extract(timers_.begin());
    const auto timer = entry.mapped();
    if (!timer->active) continue;
    // Ticks that a long callback made us miss are left out; the rest keep their rhythm.
    const auto late = (now - entry.key()) / timer->period;
    entry.key() += std::chrono::duration_cast<Clock::duration>(timer->period * (late + 1));
    timers_.insert(std::move(entry));
    return Work{"timer " + timer->callback.name, [timer] {
                  if (timer->active) timer->callback.run();
                }};
  }
  return std::nullopt;
}

std::optional<Work> Executor::take_due(Clock::time_point now) {
  // Timers that take longer than their period would else keep messages waiting for ever, and a flood of
  // messages the timers.
  const bool after_timer = std::exchange(timer_ran_last_, false);
  if (!after_timer || posted_.empty()) {
    if (auto timer = take_timer(now)) {
      timer_ran_last_ = true;
      return timer;
    }
  }
  if (posted_.empty()) {
    if (!std::exchange(woken_, false)) return std::nullopt;
    return Work([] {});
  }
  std::optional<Work> next(std::move(posted_.front()));
  posted_.pop_front();
  return next;
}

bool Executor::run_one(Clock::time_point deadline) {
  std::unique_lock lock(mutex_);
  while (!stopped_) {
    const auto now = Clock::now();
    if (const auto due = take_due(now)) {
      lock.unlock();
      record_->run(*due);
      return true;
    }
    if (now >= deadline) return false;
    changed_.wait_until(lock, timers_.empty() ? deadline : std::min(deadline, timers_.begin()->first));
  }
  return false;
}

}  // namespace fleetmap::bus
