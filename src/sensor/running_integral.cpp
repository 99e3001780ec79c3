#include "fleetmap/sensor/running_integral.hpp"

#include <algorithm>

namespace fleetmap::sensor {
namespace {

constexpr Duration kEntriesKept = std::chrono::seconds(3);
constexpr Duration kGap = std::chrono::milliseconds(500);

}  // namespace

void RunningIntegral::add(Stamp stamp, const Eigen::Vector3d& rate) {
  if (!rate.allFinite()) return;
  if (!entries_.empty() && (stamp <= entries_.back().stamp || stamp - entries_.back().stamp > kGap))
    entries_.clear();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  if (!entries_.empty()) {
    const Entry& last = entries_.back();
    sum = last.sum + 0.5 * to_seconds(stamp - last.stamp) * (last.rate + rate);
  }
  entries_.push_back({stamp, rate, sum});
  while (stamp - entries_.front().stamp > kEntriesKept) entries_.pop_front();
}

std::optional<Stamp> RunningIntegral::last() const {
  return entries_.empty() ? std::nullopt : std::optional(entries_.back().stamp);
}

std::optional<Eigen::Vector3d> RunningIntegral::at(Stamp stamp) const {
  const auto after = std::ranges::lower_bound(entries_, stamp, {}, &Entry::stamp);
  if (after == entries_.end()) return std::nullopt;
  if (after->stamp == stamp) return after->sum;
  if (after == entries_.begin()) return std::nullopt;
  const auto before = std::prev(after);
  const double share = to_seconds(stamp - before->stamp) / to_seconds(after->stamp - before->stamp);
  return before->sum + share * (after->sum - before->sum);
}

std::optional<Eigen::Vector3d> RunningIntegral::between(Stamp from, Stamp to) const {
  const auto begin = at(from), end = at(to);
  if (!begin || !end) return std::nullopt;
  return *end - *begin;
}

}  // namespace fleetmap::sensor
