#include "rate_history.hpp"

#include <algorithm>

#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::odometry {
namespace {

constexpr std::ptrdiff_t kMinForTrend = 5;
constexpr std::size_t kMaxSamples = 8192;
constexpr Duration kClockJump = std::chrono::seconds(1);
constexpr Duration kMaxGap = std::chrono::milliseconds(500);  // between samples that still cover an interval

}  // namespace

bool RateHistory::add(Stamp stamp, const Eigen::Vector3d& rate) {
  if (!rate.allFinite()) return false;
  if (!samples_.empty() && stamp <= samples_.back().stamp) {
    if (samples_.back().stamp - stamp < kClockJump) return false;
    samples_.clear();
  }
  samples_.push_back({stamp, rate});
  if (samples_.size() > kMaxSamples) samples_.pop_front();
  return true;
}

bool RateHistory::covers(Stamp from, Stamp to, Duration hold) const {
  if (samples_.empty() || samples_.front().stamp > from + hold || samples_.back().stamp < to - hold)
    return false;
  const auto first = std::lower_bound(samples_.begin(), samples_.end(), from,
                                      [](const Sample& s, Stamp stamp) { return s.stamp < stamp; });
  for (auto it = first == samples_.begin() ? first : std::prev(first); it != samples_.end() && it->stamp < to;
       ++it) {
    const auto next = std::next(it);
    if (next != samples_.end() && next->stamp - it->stamp > kMaxGap) return false;
  }
  return true;
}

Eigen::Vector3d RateHistory::at(Stamp stamp) const {
  const auto after = std::lower_bound(samples_.begin(), samples_.end(), stamp,
                                      [](const Sample& s, Stamp t) { return s.stamp < t; });
  if (after == samples_.begin()) return after->rate;
  if (after == samples_.end()) return samples_.back().rate;
  const auto before = std::prev(after);
  const double alpha = to_seconds(stamp - before->stamp) / to_seconds(after->stamp - before->stamp);
  return (1.0 - alpha) * before->rate + alpha * after->rate;
}

template <class Visitor>
void RateHistory::for_each_piece(Stamp from, Stamp to, const Visitor& visit) const {
  Stamp stamp = from;
  Eigen::Vector3d rate = at(from);
  const auto advance = [&](Stamp next, const Eigen::Vector3d& next_rate) {
    visit(to_seconds(next - stamp), rate, next_rate);
    stamp = next;
    rate = next_rate;
  };
  for (auto it = std::upper_bound(samples_.begin(), samples_.end(), from,
                                  [](Stamp t, const Sample&s) { return t < s.stamp; });
       it != samples_.end() && it->stamp < to; ++it) {
    advance(it->stamp, it->rate);
  }
  advance(to, at(to));
}

std::optional<Eigen::Vector3d> RateHistory::mean(Stamp from, Stamp to, Duration hold) const {
  if (!covers(from, to, hold)) return std::nullopt;
  if (to <= from) return at(from);
  Eigen::Vector3d integral = Eigen::Vector3d::Zero();
  for_each_piece(from, to, [&](double seconds, const Eigen::Vector3d& rate, const Eigen::Vector3d& next) {
    integral += 0.5 * seconds * (rate + next);
  });
  return integral / to_seconds(to - from);
}

std::optional<Eigen::Matrix3d> RateHistory::rotation(Stamp from, Stamp to, const Eigen::Vector3d& bias,
                                                     Duration hold) const {
  if (!covers(from, to, hold)) return std::nullopt;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  for_each_piece(from, to, [&](double seconds, const Eigen::Vector3d& rate, const Eigen::Vector3d& next) {
    R = R * so3_exp(seconds * (0.5 * (rate + next) - bias));
  });
  return R;
}

std::optional<RateHistory::Trend> RateHistory::trend(Stamp from, Stamp to) const {
  const auto before = [](const Sample& s, Stamp t) { return s.stamp < t; };
  const auto first = std::lower_bound(samples_.begin(), samples_.end(), from, before);
  const auto last =
      std::upper_bound(first, samples_.end(), to, [](Stamp t, const Sample& s) { return t < s.stamp; });
  const auto n = static_cast<double>(last - first);
  if (last - first < kMinForTrend) return std::nullopt;
  double time = 0.0, square_time = 0.0;
  Eigen::Vector3d rate = Eigen::Vector3d::Zero(), square_rate = rate, product = rate;
  for (auto it = first; it != last; ++it) {
    const double t = to_seconds(it->stamp - from);
    const Eigen::Vector3d r = it->rate - first->rate;
    time += t;
    square_time += t * t;
    rate += r;
    square_rate += r.cwiseAbs2();
    product += t * r;
  }
  const double spread = square_time - time * time / n;
  const Eigen::Vector3d slope = (product - time / n * rate) / spread;
  const Eigen::Vector3d rest = square_rate - rate.cwiseAbs2() / n - spread * slope.cwiseAbs2();
  return Trend{slope, rest.cwiseMax(0.0) / ((n - 2.0) * spread)};
}

}  // namespace fleetmap::odometry
