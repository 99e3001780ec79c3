#include "sweep.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace fleetmap::odometry {
namespace {

constexpr std::uint16_t kNoRing = 0xffff;
constexpr std::size_t kSlopeBins = 8192;
constexpr float kMaxSlope = 4.0f;  // 76 degrees
constexpr float kTwoPi = 2.0f * std::numbers::pi_v<float>;

/// atan2 to 1e-4 rad, several times faster than the library's; used for times only.
float fast_atan2(float y, float x) {
  const float ax = std::abs(x), ay = std::abs(y);
  const float a = std::min(ax, ay) / (std::max(ax, ay) + 1e-20f);
  const float s = a * a;
  float r = ((-0.0464964749f * s + 0.15931422f) * s - 0.327622764f) * s * a + a;
  if (ay > ax) r = 0.5f * std::numbers::pi_v<float> - r;
  if (x < 0.0f) r = std::numbers::pi_v<float> - r;
  return y < 0.0f ? -r : r;
}

float slope(const Eigen::Vector3f& p) { return p.z() / (std::hypot(p.x(), p.y()) + 1e-6f); }

/// For each elevation bin the nearest ring, or none if it is farther than a ring's spacing.
std::vector<std::uint16_t> slope_table(const std::vector<double>& angles) {
  std::vector<std::uint16_t> table(kSlopeBins, kNoRing);
  if (angles.empty()) return table;
  const auto [low, high] = std::minmax_element(angles.begin(), angles.end());
  const double spacing = (*high - *low) / static_cast<double>(std::max<std::size_t>(1, angles.size() - 1));
  const double reach = std::max(spacing, 0.02);
  for (std::size_t bin = 0; bin < kSlopeBins; ++bin) {
    const double tangent = (2.0 * (static_cast<double>(bin) + 0.5) / kSlopeBins - 1.0) * kMaxSlope;
    const double elevation = std::atan(tangent);
    const auto nearest = std::min_element(angles.begin(), angles.end(), [&](double a, double b) {
      return std::abs(a - elevation) < std::abs(b - elevation);
    });
    if (std::abs(*nearest - elevation) < reach) {
      table[bin] = static_cast<std::uint16_t>(nearest - angles.begin());
    }
  }
  return table;
}

}  // namespace

SweepBuilder::SweepBuilder(const LoamConfig& config, LidarModel model)
    : min_range_(config.min_range),
      max_range_(config.max_range),
      R_base_lidar_(config.T_base_lidar.linear().cast<float>()),
      t_base_lidar_(config.T_base_lidar.translation().cast<float>()),
      model_(std::move(model)),
      ring_by_slope_(slope_table(model_.vertical_angles)) {}

const Sweep& SweepBuilder::build(const sensor::Scan& scan) {
  defects_ = {};
  sweep_.stamp = scan.stamp;
  sweep_.reference_offset = 0.0;
  ranges_.resize(scan.points.size());
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Eigen::Vector3f& p = scan.points[i].position;
    const float range = std::sqrt(p.squaredNorm());
    const bool finite = std::isfinite(range);
    const bool inside =
        finite && range >= static_cast<float>(min_range_) && range <= static_cast<float>(max_range_);
    defects_.non_finite += !finite;
    defects_.out_of_range += finite && !inside;
    ranges_[i] = inside ? range : -1.0f;
  }
  assign_rings(scan);
  const bool times = usable_times(scan);
  sort_by_ring(scan);
  sweep_.has_times = times;
  if (times) {
    for (std::size_t i = 0; i < order_.size(); ++i) sweep_.points[i].time = scan.points[order_[i]].time;
  } else {
    times_from_azimuth(scan);
  }
  center_times();
  return sweep_;
}

void SweepBuilder::assign_rings(const sensor::Scan& scan) {
  rings_.assign(scan.points.size(), kNoRing);
  ring_count_ = 0;
  const bool use_field = scan.has_ring && rings_plausible(scan);
  defects_.rings_ignored = scan.has_ring && !use_field;
  if (use_field) {
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      if (scan.points[i].ring < kMaxRings) rings_[i] = scan.points[i].ring;
    }
  } else if (model_.has_rings() && model_.ring_source == RingSource::kPointOrder) {
    rings_by_order(scan);
  } else if (model_.has_rings() && model_.ring_source == RingSource::kElevation) {
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      if (ranges_[i] > 0.0f) rings_[i] = ring_by_elevation(scan.points[i].position);
    }
  }
  for (const std::uint16_t ring : rings_) {
    if (ring != kNoRing) ring_count_ = std::max<std::size_t>(ring_count_, ring + std::size_t{1});
  }
}

/// A ring is a cone: the elevations within the rings must vary much less than those of the whole scan.
bool SweepBuilder::rings_plausible(const sensor::Scan& scan) const {
  struct Moments {
    double n = 0, sum = 0, square = 0;
    void add(double value) { n += 1, sum += value, square += value * value; }
    double spread() const { return n > 0 ? square - sum * sum / n : 0.0; }
  };
  std::array<Moments, kMaxRings> rings{};
  Moments all;
  for (std::size_t i = 0; i < scan.points.size(); i += 4) {
    if (ranges_[i] <= 0.0f || scan.points[i].ring >= kMaxRings) continue;
    const double value = slope(scan.points[i].position);
    rings[scan.points[i].ring].add(value);
    all.add(value);
  }
  double within = 0.0;
  for (const Moments& ring : rings) within += ring.spread();
  constexpr double kSingleRing = 1e-4;  // variance of slope: one ring's width
  return all.n > 0 && (within < 0.3 * all.spread() || all.spread() < kSingleRing * all.n);
}

/// Each ring starts and ends facing forward and turns to the left, so y goes from - to + where a ring begins.
void SweepBuilder::rings_by_order(const sensor::Scan& scan) {
  std::uint16_t ring = 0;
  float previous_y = 1.0f;
  const std::size_t last_ring = model_.vertical_angles.size() - 1;
  bool overflow = false;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Eigen::Vector3f& p = scan.points[i].position;
    if (!p.allFinite() || (p.x() == 0.0f && p.y() == 0.0f)) continue;
    if (p.x() > 0.0f && previous_y < 0.0f && p.y() >= 0.0f) {
      if (ring == last_ring) overflow = true;
      ++ring;
    }
    previous_y = p.y();
    if (ranges_[i] > 0.0f) rings_[i] = ring;
  }
  if (!overflow && ring >= last_ring / 2) return;
  // Not ring by ring after all: fall back to the elevation table.
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    rings_[i] = ranges_[i] > 0.0f ? ring_by_elevation(scan.points[i].position) : kNoRing;
  }
}

std::uint16_t SweepBuilder::ring_by_elevation(const Eigen::Vector3f& position) const {
  const float bin = (slope(position) / kMaxSlope + 1.0f) * 0.5f * kSlopeBins;
  if (!(bin >= 0.0f && bin < static_cast<float>(kSlopeBins))) return kNoRing;
  return ring_by_slope_[static_cast<std::size_t>(bin)];
}

/// Times may count from the start, the middle or the end of a sweep, hence two periods either way.
bool SweepBuilder::usable_times(const sensor::Scan& scan) {
  if (!scan.has_time) return false;
  const float limit = static_cast<float>(2.0 * model_.scan_period);
  std::size_t valid = 0;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (ranges_[i] <= 0.0f) continue;
    ++valid;
    if (!(std::abs(scan.points[i].time) <= limit)) ++defects_.bad_times;
  }
  defects_.times_ignored = defects_.bad_times * 10 > valid;
  if (defects_.times_ignored) return false;
  if (defects_.bad_times > 0) {
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      if (!(std::abs(scan.points[i].time) <= limit)) ranges_[i] = -1.0f;
    }
  }
  return true;
}

void SweepBuilder::sort_by_ring(const sensor::Scan& scan) {
  sweep_.ring_begin.assign(ring_count_ + 2, 0);
  auto slot = [this](std::size_t i) { return rings_[i] == kNoRing ? ring_count_ : std::size_t{rings_[i]}; };
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (ranges_[i] > 0.0f) ++sweep_.ring_begin[slot(i) + 1];
  }
  for (std::size_t r = 0; r + 1 < sweep_.ring_begin.size(); ++r)
    sweep_.ring_begin[r + 1] += sweep_.ring_begin[r];
  order_.resize(sweep_.ring_begin.back());
  std::array<std::uint32_t, kMaxRings + 1> next;
  std::copy_n(sweep_.ring_begin.begin(), ring_count_ + 1, next.begin());
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (ranges_[i] > 0.0f) order_[next[slot(i)]++] = static_cast<std::uint32_t>(i);
  }
  sweep_.ring_begin.pop_back();
  if (ring_count_ == 0) sweep_.ring_begin.clear();
  sweep_.points.resize(order_.size());
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const sensor::ScanPoint& p = scan.points[order_[i]];
    sweep_.points[i] = {R_base_lidar_ * p.position + t_base_lidar_, p.intensity, 0.0f, ranges_[order_[i]]};
  }
}

/// Without times of points the azimuth gives the time of firing, since the sensor turns at a constant rate.
void SweepBuilder::times_from_azimuth(const sensor::Scan& scan) {
  if (sweep_.rings() == 0) return;
  float start = 0.0f;
  if (model_.sweep_start_azimuth) {
    start = static_cast<float>(*model_.sweep_start_azimuth);
  } else {
    const auto first = std::find_if(ranges_.begin(), ranges_.end(), [](float range) { return range > 0.0f; });
    if (first == ranges_.end()) return;
    const Eigen::Vector3f& p = scan.points[static_cast<std::size_t>(first - ranges_.begin())].position;
    start = fast_atan2(p.y(), p.x());
  }
  const float sign = model_.clockwise ? -1.0f : 1.0f;
  const float period = static_cast<float>(model_.scan_period);
  const float offset = static_cast<float>(model_.stamp_phase) * period;
  for (std::size_t r = 0; r < sweep_.rings(); ++r) {
    const std::size_t begin = sweep_.ring_begin[r], end = sweep_.ring_begin[r + 1];
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3f& p = scan.points[order_[i]].position;
      float turn = sign * (fast_atan2(p.y(), p.x()) - start) / kTwoPi;
      turn -= std::floor(turn);
      if (!model_.sweep_start_azimuth) {  // firing order: where the turn closes, the order tells first from
                                          // last
        if (turn > 0.9f && (i - begin) * 4 < end - begin) turn -= 1.0f;
        if (turn < 0.1f && (i - begin) * 4 > 3 * (end - begin)) turn += 1.0f;
      }
      sweep_.points[i].time = turn * period - offset;
    }
  }
  sweep_.has_times = true;
}

void SweepBuilder::center_times() {
  if (!sweep_.has_times || sweep_.points.empty()) return;
  const auto [first, last] =
      std::minmax_element(sweep_.points.begin(), sweep_.points.end(),
                          [](const SweepPoint& a, const SweepPoint& b) { return a.time < b.time; });
  const float middle = 0.5f * (first->time + last->time);
  for (SweepPoint& p : sweep_.points) p.time -= middle;
  sweep_.reference_offset = middle;
}

}  // namespace fleetmap::odometry
