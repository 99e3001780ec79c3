#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fleetmap/experiment/case_record.hpp"

namespace fleetmap::experiment {

/// A metric's values along an axis: values[k][s] at x[k] of seed s, the same seeds everywhere.
struct Curve {
  std::vector<double> x;
  std::vector<std::vector<double>> values;
  double resolution = 0.0;  ///< values are rounded to multiples of it; 0: they are not
};

/// Residual of a curve's values after each seed's and each point's mean is subtracted: sigma of a single run
/// that no change along the axis explains.
struct Residual {
  double sigma = 0.0;
  double freedom = 0.0;  ///< degrees of freedom, (points - 1) * (seeds - 1)
};
/// Two-way analysis of variance without replication (a randomised block design, seeds are the blocks). All
/// points share one sigma, so that a few equal differences cannot make it vanish; it is never less than the
/// resolution's own, resolution / sqrt(12). NaN with one seed.
Residual residual_of(const Curve& curve);

/// Comparison of a curve with the shape that it is expected to have.
struct Trend {
  std::vector<double> means;
  double change = 0.0;     ///< last mean less the first
  double slope = 0.0;      ///< of the least-squares line through the means, a unit of x
  double p = 1.0;          ///< one-sided: chance of such slopes if there were no trend; NaN with one seed
  double tolerance = 0.0;  ///< the largest step back that the seeds explain; NaN with one seed
  std::string violation;   ///< which rule is broken and by how much; empty: none
  bool holds() const { return violation.empty(); }
};

/// The rules, on means over the seeds (seeds are paired: the same seed is the same world and noise at every
/// x):
/// 1. the last mean lies beyond the first in the expected direction;
/// 2. the least-squares line through the means goes in that direction;
/// 3. no mean steps back from its neighbour by more than the seeds explain: Fisher's least significant
/// difference, t * sigma * sqrt(2 / seeds) with residual_of()'s sigma and t the one-sided 97.5 % point of
/// Student's distribution of its freedom (one seed: any step is allowed).
/// p is the larger of two: that of the seeds' slopes (seeds - 1 degrees of freedom), and that of the same
/// contrast with residual_of()'s sigma, which two equal slopes do not make 0.
/// `falling` tests for falls, else for rises.
Trend check_trend(const Curve& curve, bool falling);

/// Whether a mean lies above the first (`falling`: below) by `by` or more, which is violated (a test of
/// non-inferiority). p is the chance of these means, the largest of all points, if one of them truly differed
/// by `by`: from the paired differences with residual_of()'s sigma.
Trend check_limit(const Curve& curve, bool falling, double by);

/// Result of the check of a curve's expected shape.
enum class Verdict : std::uint8_t {
  kHolds,
  kHoldsWeakly,  ///< the means have the shape, but with these few seeds chance could have made it (p > 0.05)
  kViolated,
  kNoData,  ///< fewer than two points have a seed in common
};
const char* to_string(Verdict verdict);

/// An expectation at one combination of the other axes.
struct ShapeCheck {
  std::string study;
  config::Expectation expectation;
  std::string at;  ///< "rate_hz=10"; empty: there are no other axes
  Verdict verdict = Verdict::kNoData;
  std::vector<double> x, means;  ///< of log-scale metrics geometric means
  std::size_t seeds = 0;         ///< that gave the metric at every x
  std::size_t seeds_planned = 0;
  double change = 0.0;  ///< last mean less the first; of log-scale metrics the last over the first
  double p = 1.0;
  double tolerance = 0.0;  ///< Trend::tolerance; of log-scale metrics of logarithms
  std::string detail;      ///< in words: what was measured, or which rule is broken and by how much
};

/// Falls-less-than-linearly is: the metric falls, and the metric times x rises (each robot more brings less
/// than its share: a fleet of x times the robots would need 1/x of the time if nothing were lost).
std::vector<ShapeCheck> check_shapes(const config::ExperimentConfig& config,
                                     const std::vector<CaseRecord>& records);

}  // namespace fleetmap::experiment
