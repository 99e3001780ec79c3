#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace fleetmap::sensor {

/// Errors in units of the sigma that was stated for them.
class NormalisedErrors {
 public:
  void add(double error, double sigma) {
    const double normalised = error / sigma;
    squares_ += normalised * normalised;
    worst_ = std::max(worst_, std::abs(normalised));
    ++count_;
  }
  double rms() const { return std::sqrt(squares_ / static_cast<double>(count_)); }
  double worst() const { return worst_; }

 private:
  double squares_ = 0.0, worst_ = 0.0;
  std::size_t count_ = 0;
};

}  // namespace fleetmap::sensor
