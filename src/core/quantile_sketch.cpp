#include "fleetmap/core/quantile_sketch.hpp"

#include <algorithm>
#include <cmath>

namespace fleetmap {
namespace {

/// Bin k holds values in (kMin g^(k-1), kMin g^k]; bin 0 what is less, the last bin what is more.
const double kLogGrowth =
    std::log((1.0 + QuantileSketch::kRelativeError) / (1.0 - QuantileSketch::kRelativeError));

std::size_t bin_of(double value) {
  const double bin = std::ceil(
      std::log(std::clamp(value, QuantileSketch::kMin, QuantileSketch::kMax) / QuantileSketch::kMin) /
      kLogGrowth);
  return static_cast<std::size_t>(bin);
}

/// Differs from every value of the bin by at most kRelativeError.
double value_of(std::size_t bin) {
  return QuantileSketch::kMin * std::exp(kLogGrowth * static_cast<double>(bin)) *
         (1.0 - QuantileSketch::kRelativeError);
}

}  // namespace

void QuantileSketch::add(double value) {
  if (counts_.empty()) counts_.resize(bin_of(kMax) + 1);
  ++counts_[bin_of(value)];
  min_ = count_ == 0 ? value : std::min(min_, value);
  max_ = count_ == 0 ? value : std::max(max_, value);
  sum_ += value;
  ++count_;
}

double QuantileSketch::quantile(double q) const {
  if (count_ == 0) return 0.0;
  const auto rank = static_cast<std::uint64_t>(q * static_cast<double>(count_ - 1) + 0.5);
  if (rank == 0) return min_;
  if (rank + 1 == count_) return max_;
  std::uint64_t below = 0;
  for (std::size_t bin = 0; bin < counts_.size(); ++bin) {
    below += counts_[bin];
    if (below > rank) return std::clamp(value_of(bin), min_, max_);
  }
  return max_;
}

}  // namespace fleetmap
