#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fleetmap {

/// Distribution of positive values (CPU times in s, for example) in memory that does not grow with their
/// number: counts of logarithmic bins (DDSketch; Masson et al., "DDSketch: A fast and fully-mergeable
/// quantile sketch with relative-error guarantees", VLDB 2019). Count, sum, least and largest value are
/// exact.
class QuantileSketch {
 public:
  static constexpr double kRelativeError = 0.005;  ///< of a quantile within [kMin, kMax]
  static constexpr double kMin = 1e-6, kMax = 1e4;

  void add(double value);
  std::uint64_t count() const { return count_; }
  double min() const { return min_; }  ///< 0 without values, as all of the following
  double max() const { return max_; }
  double sum() const { return sum_; }
  double mean() const { return count_ == 0 ? 0.0 : sum_ / static_cast<double>(count_); }
  /// The value of rank round(q (count - 1)), for q in [0, 1].
  double quantile(double q) const;
  /// Bins in memory.
  std::size_t bins() const { return counts_.size(); }

 private:
  std::vector<std::uint64_t> counts_;  ///< all bins, once there is a value
  std::uint64_t count_ = 0;
  double sum_ = 0.0, min_ = 0.0, max_ = 0.0;
};

}  // namespace fleetmap
