#include "fleetmap/eval/consistency.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace fleetmap::eval {
namespace {

constexpr std::size_t kMaxDimensions = 6;
/// Quantiles of the chi-square distribution with 1 to 6 degrees of freedom.
constexpr std::array<double, kMaxDimensions> kMedian{0.4549, 1.3863, 2.3660, 3.3567, 4.3515, 5.3481};
constexpr std::array<double, kMaxDimensions> kWithin95{3.8415, 5.9915, 7.8147, 9.4877, 11.0705, 12.5916};

/// At share q of the sorted values, between neighbours by line.
double quantile(const std::vector<double>& sorted, double q) {
  const double at = q * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

bool usable(const StatedError& one, Eigen::Index dimensions) {
  return one.error.size() == dimensions && one.covariance.rows() == dimensions &&
         one.covariance.cols() == dimensions && one.error.allFinite() && one.covariance.allFinite() &&
         (one.covariance.diagonal().array() > 0.0).all();
}

}  // namespace

Vector6d tangent_error(const Pose& T_true, const Pose& T_estimate) {
  return se3_log(T_true.inverse() * T_estimate);
}

Consistency consistency(std::span<const StatedError> errors) {
  Consistency result;
  if (errors.empty()) return result;
  const Eigen::Index dimensions = errors.front().error.size();
  if (dimensions < 1 || dimensions > static_cast<Eigen::Index>(kMaxDimensions)) {
    result.refused = errors.size();
    return result;
  }
  result.dimensions = static_cast<std::size_t>(dimensions);
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(dimensions);
  std::vector<double> normalised;
  std::size_t within = 0;
  for (const StatedError& one : errors) {
    if (!usable(one, dimensions)) {
      ++result.refused;
      continue;
    }
    // In units of each dimension's sigma: metres and radians differ by magnitudes.
    const Eigen::VectorXd sigma = one.covariance.diagonal().cwiseSqrt();
    const Eigen::VectorXd scaled = one.error.cwiseQuotient(sigma);
    const Eigen::MatrixXd correlation =
        sigma.cwiseInverse().asDiagonal() * one.covariance * sigma.cwiseInverse().asDiagonal();
    const Eigen::LLT<Eigen::MatrixXd> cholesky(correlation);
    if (cholesky.info() != Eigen::Success) {
      ++result.refused;
      continue;
    }
    const double nees = scaled.dot(cholesky.solve(scaled));
    normalised.push_back(nees / static_cast<double>(dimensions));
    within += nees <= kWithin95[result.dimensions - 1] ? 1u : 0u;
    squares += scaled.cwiseAbs2();
  }
  result.count = normalised.size();
  if (normalised.empty()) return result;
  const auto count = static_cast<double>(normalised.size());
  std::ranges::sort(normalised);
  for (const double value : normalised) result.mean += value / count;
  result.median = quantile(normalised, 0.5);
  result.expected_median = kMedian[result.dimensions - 1] / static_cast<double>(dimensions);
  result.within_95 = static_cast<double>(within) / count;
  for (Eigen::Index k = 0; k < dimensions; ++k) result.axes.push_back(std::sqrt(squares[k] / count));
  return result;
}

Spread spread(std::vector<double> values) {
  Spread result;
  result.count = values.size();
  if (values.empty()) return result;
  std::ranges::sort(values);
  double squares = 0.0;
  for (const double value : values) squares += value * value;
  result.rms = std::sqrt(squares / static_cast<double>(values.size()));
  result.p50 = quantile(values, 0.5);
  result.p90 = quantile(values, 0.9);
  result.p95 = quantile(values, 0.95);
  result.p99 = quantile(values, 0.99);
  result.max = values.back();
  return result;
}

}  // namespace fleetmap::eval
