#include "driving/local_field.hpp"

#include <algorithm>
#include <cmath>

namespace fleetmap::planning {
namespace {

constexpr double kFine = 0.1;    // m, cells of the distances
constexpr double kCoarse = 0.2;  // m, cells of the costs
constexpr int kMaxRounds = 6;    // of four sweeps: enough for any way that turns back less often

}  // namespace

LocalField::LocalField(double reach, double far)
    : reach_(kCoarse * std::ceil(reach / kCoarse)),
      far_(far),
      fine_(static_cast<int>(std::lround(2.0 * reach_ / kFine))),
      coarse_(static_cast<int>(std::lround(2.0 * reach_ / kCoarse))),
      row_distance_(static_cast<std::size_t>(fine_ * fine_)),
      distance_(row_distance_.size(), static_cast<float>(far)),
      price_(static_cast<std::size_t>(coarse_ * coarse_)),
      cost_(price_.size()) {}

/// Exact distances between cells, up to `far`: along the rows first, then down the columns.
void LocalField::see(std::span<const Eigen::Vector2d> obstacles) {
  const auto far = static_cast<float>(far_);
  std::ranges::fill(row_distance_, far);
  bool any = false;
  for (const Eigen::Vector2d& p : obstacles) {
    if (!p.allFinite() || !inside(p)) continue;
    const int x = std::min(fine_ - 1, static_cast<int>((p.x() + reach_) / kFine));
    const int y = std::min(fine_ - 1, static_cast<int>((p.y() + reach_) / kFine));
    row_distance_[static_cast<std::size_t>(y * fine_ + x)] = 0.0f;
    any = true;
  }
  std::ranges::fill(distance_, far);
  if (!any) return;
  const auto step = static_cast<float>(kFine);
  for (int y = 0; y < fine_; ++y) {
    float* row = row_distance_.data() + y * fine_;
    for (int x = 1; x < fine_; ++x) row[x] = std::min(row[x], row[x - 1] + step);
    for (int x = fine_ - 2; x >= 0; --x) row[x] = std::min(row[x], row[x + 1] + step);
  }
  const int window = static_cast<int>(far_ / kFine);
  std::vector<float> best(static_cast<std::size_t>(fine_));
  for (int y = 0; y < fine_; ++y) {
    std::ranges::fill(best, far * far);
    for (int other = std::max(0, y - window); other <= std::min(fine_ - 1, y + window); ++other) {
      const float dy = static_cast<float>(other - y) * step;
      const float* row = row_distance_.data() + other * fine_;
      for (int x = 0; x < fine_; ++x) {
        const float square = row[x] * row[x] + dy * dy;
        best[static_cast<std::size_t>(x)] = std::min(best[static_cast<std::size_t>(x)], square);
      }
    }
    for (int x = 0; x < fine_; ++x) {
      distance_[static_cast<std::size_t>(y * fine_ + x)] = std::sqrt(best[static_cast<std::size_t>(x)]);
    }
  }
}

double LocalField::clearance(const Eigen::Vector2d& p) const {
  if (!inside(p)) return far_;
  const int x = std::min(fine_ - 1, static_cast<int>((p.x() + reach_) / kFine));
  const int y = std::min(fine_ - 1, static_cast<int>((p.y() + reach_) / kFine));
  return distance_[static_cast<std::size_t>(y * fine_ + x)];
}

double LocalField::price_of_metre(double clearance) const {
  const double tight = std::max(0.0, 1.0 - clearance / far_);
  return 1.0 + 2.0 * tight * tight;
}

double LocalField::centre(int k) const { return (k + 0.5) * kCoarse - reach_; }

void LocalField::spread(std::span<const Source> sources, double radius) {
  for (int y = 0; y < coarse_; ++y) {
    for (int x = 0; x < coarse_; ++x) {
      const double clear = clearance({centre(x), centre(y)});
      price_[static_cast<std::size_t>(y * coarse_ + x)] =
          clear < radius ? -1.0f : static_cast<float>(kCoarse * price_of_metre(clear));
    }
  }
  std::ranges::fill(cost_, static_cast<float>(kUnreachable));
  for (const Source& source : sources) {
    if (!inside(source.at)) continue;
    const int x = std::min(coarse_ - 1, static_cast<int>((source.at.x() + reach_) / kCoarse));
    const int y = std::min(coarse_ - 1, static_cast<int>((source.at.y() + reach_) / kCoarse));
    const auto k = static_cast<std::size_t>(y * coarse_ + x);
    if (price_[k] > 0.0f) cost_[k] = std::min(cost_[k], static_cast<float>(source.cost));
  }
  for (int round = 0; round < kMaxRounds; ++round) {
    bool changed = false;
    for (const int y_step : {1, -1}) {
      for (const int x_step : {1, -1}) changed |= sweep(x_step, y_step);
    }
    if (!changed) return;
  }
}

/// Godunov's upwind scheme in one direction over all cells.
bool LocalField::sweep(int x_step, int y_step) {
  bool changed = false;
  const auto unreachable = static_cast<float>(kUnreachable);
  for (int j = 0; j < coarse_; ++j) {
    const int y = y_step > 0 ? j : coarse_ - 1 - j;
    for (int i = 0; i < coarse_; ++i) {
      const int x = x_step > 0 ? i : coarse_ - 1 - i;
      const int k = y * coarse_ + x;
      const auto at = [this](int index) { return cost_[static_cast<std::size_t>(index)]; };
      const float price = price_[static_cast<std::size_t>(k)];
      if (price < 0.0f) continue;
      const float a = std::min(x > 0 ? at(k - 1) : unreachable, x + 1 < coarse_ ? at(k + 1) : unreachable);
      const float b =
          std::min(y > 0 ? at(k - coarse_) : unreachable, y + 1 < coarse_ ? at(k + coarse_) : unreachable);
      const float low = std::min(a, b);
      if (low >= unreachable) continue;
      const float gap = std::abs(a - b);
      const float value =
          gap >= price ? low + price : 0.5f * (a + b + std::sqrt(2.0f * price * price - gap * gap));
      if (value < at(k) - 1e-3f) {
        cost_[static_cast<std::size_t>(k)] = value;
        changed = true;
      }
    }
  }
  return changed;
}

double LocalField::cost(const Eigen::Vector2d& p) const {
  if (!inside(p)) return kUnreachable;
  const double fx = std::clamp((p.x() + reach_) / kCoarse - 0.5, 0.0, coarse_ - 1.001);
  const double fy = std::clamp((p.y() + reach_) / kCoarse - 0.5, 0.0, coarse_ - 1.001);
  const int x = static_cast<int>(fx);
  const int y = static_cast<int>(fy);
  // Unreachable cells are left out of the interpolation, since those beside them may be reachable.
  double sum = 0.0;
  double weights = 0.0;
  for (int dy = 0; dy < 2; ++dy) {
    for (int dx = 0; dx < 2; ++dx) {
      const double value = cost_[static_cast<std::size_t>((y + dy) * coarse_ + x + dx)];
      const double weight = (dx ? fx - x : 1.0 - (fx - x)) * (dy ? fy - y : 1.0 - (fy - y));
      if (value >= kUnreachable) continue;
      sum += weight * value;
      weights += weight;
    }
  }
  return weights > 0.05 ? sum / weights : kUnreachable;
}

}  // namespace fleetmap::planning
