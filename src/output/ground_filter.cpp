#include "ground_filter.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <functional>
#include <limits>

namespace fleetmap::output {
namespace {

constexpr float kNoHeight = std::numeric_limits<float>::quiet_NaN();
constexpr float kPit = 0.5f;  // m, below all neighbours

/// Row-major heights, NaN where there are none.
struct Heights {
  std::vector<float> values;
  std::ptrdiff_t width = 0;
  std::ptrdiff_t rows() const { return static_cast<std::ptrdiff_t>(values.size()) / width; }
  float& at(std::ptrdiff_t x, std::ptrdiff_t y) { return values[static_cast<std::size_t>(y * width + x)]; }
};

/// Replaces each of `count` values, `stride` apart, by the first of `before` within `radius` of it, in one
/// pass (monotonic queue). NaN is passed over, and replaced as well.
template <class Before>
void slide(float* values, std::ptrdiff_t count, std::ptrdiff_t stride, std::ptrdiff_t radius, Before before) {
  std::vector<float> in(static_cast<std::size_t>(count));
  for (std::ptrdiff_t k = 0; k < count; ++k) in[static_cast<std::size_t>(k)] = values[k * stride];
  const auto of = [&](std::ptrdiff_t k) { return in[static_cast<std::size_t>(k)]; };
  std::deque<std::ptrdiff_t> best;
  for (std::ptrdiff_t k = 0; k < count + radius; ++k) {
    if (k < count && !std::isnan(of(k))) {
      while (!best.empty() && !before(of(best.back()), of(k))) best.pop_back();
      best.push_back(k);
    }
    const std::ptrdiff_t middle = k - radius;
    if (middle < 0) continue;
    while (!best.empty() && best.front() < middle - radius) best.pop_front();
    if (!best.empty()) values[middle * stride] = of(best.front());
  }
}

template <class Before>
void slide_square(Heights& heights, std::ptrdiff_t radius, Before before) {
  for (std::ptrdiff_t y = 0; y < heights.rows(); ++y)
    slide(&heights.at(0, y), heights.width, 1, radius, before);
  for (std::ptrdiff_t x = 0; x < heights.width; ++x)
    slide(&heights.at(x, 0), heights.rows(), heights.width, radius, before);
}

void keep_observed(Heights& heights, const Heights& observed) {
  for (std::size_t k = 0; k < heights.values.size(); ++k) {
    if (std::isnan(observed.values[k])) heights.values[k] = kNoHeight;
  }
}

/// Erosion, then dilation: what is narrower than the window and stands above its surroundings is gone.
Heights opened(const Heights& heights, std::ptrdiff_t radius) {
  Heights result = heights;
  slide_square(result, radius, std::less<>{});
  keep_observed(result, heights);
  slide_square(result, radius, std::greater<>{});
  keep_observed(result, heights);
  return result;
}

void remove_pits(Heights& heights) {
  Heights read = heights;
  for (std::ptrdiff_t y = 0; y < heights.rows(); ++y) {
    for (std::ptrdiff_t x = 0; x < heights.width; ++x) {
      float lowest = std::numeric_limits<float>::infinity();
      int neighbours = 0;
      for (int k = 0; k < 9; ++k) {
        const std::ptrdiff_t nx = x + k % 3 - 1, ny = y + k / 3 - 1;
        if (k == 4 || nx < 0 || ny < 0 || nx >= heights.width || ny >= heights.rows()) continue;
        if (std::isnan(read.at(nx, ny))) continue;
        lowest = std::min(lowest, read.at(nx, ny));
        ++neighbours;
      }
      if (neighbours >= 3 && read.at(x, y) < lowest - kPit) heights.at(x, y) = kNoHeight;
    }
  }
}

}  // namespace

std::vector<bool> ground_cells(std::vector<float> low, int width, const ElevationConfig& config) {
  std::vector<bool> ground(low.size(), false);
  if (low.empty()) return ground;
  Heights surface{std::move(low), width};
  remove_pits(surface);
  for (std::size_t k = 0; k < ground.size(); ++k) ground[k] = !std::isnan(surface.values[k]);
  const auto widest = std::max<std::ptrdiff_t>(1, std::lround(0.5 * config.max_window_m / config.cell_m));
  std::ptrdiff_t last = 0;
  for (std::ptrdiff_t radius = 1; last < widest; radius = std::min(2 * radius, widest)) {
    // Eq. 3; in the first window the noise of the ground alone.
    const double growth = last == 0 ? 0.0 : 2.0 * static_cast<double>(radius - last) * config.cell_m;
    const auto step =
        static_cast<float>(std::min(config.slope * growth + config.first_step_m, config.max_step_m));
    Heights smooth = opened(surface, radius);
    for (std::size_t k = 0; k < ground.size(); ++k) {
      if (surface.values[k] - smooth.values[k] > step) ground[k] = false;
    }
    surface = std::move(smooth);
    last = radius;
  }
  return ground;
}

}  // namespace fleetmap::output
