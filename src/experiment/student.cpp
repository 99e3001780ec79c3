#include "student.hpp"

#include <cmath>
#include <numbers>

namespace fleetmap::experiment {

/// With t = sqrt(freedom) tan(a) the density becomes a constant times cos(a)^(freedom - 1), smooth on [0,
/// pi/2]: Simpson's rule gives it to far more digits than a verdict needs.
double student_tail(double t, double freedom) {
  if (std::isnan(t)) return t;
  if (t < 0.0) return 1.0 - student_tail(-t, freedom);
  constexpr int kIntervals = 400;
  const double from = std::atan(t / std::sqrt(freedom));
  const double step = (0.5 * std::numbers::pi - from) / kIntervals;
  double sum = 0.0;
  for (int k = 0; k <= kIntervals; ++k) {
    const double weight = k == 0 || k == kIntervals ? 1.0 : (k % 2 == 1 ? 4.0 : 2.0);
    const double cosine = std::max(0.0, std::cos(from + step * k));
    sum += weight * std::pow(cosine, freedom - 1.0);
  }
  const double log_scale = std::lgamma(0.5 * (freedom + 1.0)) - std::lgamma(0.5 * freedom);
  return std::exp(log_scale) / std::sqrt(std::numbers::pi) * sum * step / 3.0;
}

double student_quantile(double tail, double freedom) {
  double low = 0.0, high = 1.0;
  while (student_tail(high, freedom) > tail && high < 1e9) high *= 2.0;
  for (int k = 0; k < 80; ++k) {
    const double middle = 0.5 * (low + high);
    (student_tail(middle, freedom) > tail ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace fleetmap::experiment
