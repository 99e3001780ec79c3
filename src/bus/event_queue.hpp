#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>

#include "fleetmap/core/time.hpp"

namespace fleetmap::bus {

/// Virtual time: events by stamp, those of one instant in the order in which they were added.
class EventQueue {
 public:
  explicit EventQueue(Stamp start) : now_(start) {}

  Stamp now() const { return now_; }
  void at(Stamp stamp, std::function<void()> event) {
    events_.emplace(std::pair{std::max(stamp, now_), next_++}, std::move(event));
  }
  void post(std::function<void()> event) { at(now_, std::move(event)); }

  bool step() {
    if (events_.empty()) return false;
    auto next = events_.extract(events_.begin());
    now_ = next.key().first;
    next.mapped()();
    return true;
  }
  void run_until(Stamp stamp) {
    while (!events_.empty() && events_.begin()->first.first <= stamp) step();
    now_ = std::max(now_, stamp);
  }

 private:
  std::map<std::pair<Stamp, std::uint64_t>, std::function<void()>> events_;
  std::uint64_t next_ = 0;
  Stamp now_;
};

}  // namespace fleetmap::bus
