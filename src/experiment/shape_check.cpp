#include "fleetmap/experiment/shape_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "fleetmap/core/text_list.hpp"
#include "fleetmap/eval/plot.hpp"
#include "student.hpp"
#include "study_values.hpp"

namespace fleetmap::experiment {
namespace {

std::string short_number(double value) { return eval::short_number(value, 4); }

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Standard error of the mean; NaN for fewer than two values.
double standard_error(const std::vector<double>& values) {
  const double n = static_cast<double>(values.size());
  if (values.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  const double mean = mean_of(values);
  double sum = 0.0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return std::sqrt(sum / (n - 1.0) / n);
}

double slope_of(const std::vector<double>& x, const std::vector<double>& y) {
  const double x_mean = mean_of(x), y_mean = mean_of(y);
  double xx = 0.0, xy = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    xx += (x[k] - x_mean) * (x[k] - x_mean);
    xy += (x[k] - x_mean) * (y[k] - y_mean);
  }
  return xx > 0.0 ? xy / xx : 0.0;
}

/// Chance that the seeds' slopes have this mean or one farther in the expected direction without any trend.
double slope_chance(const Curve& curve, const Residual& residual, double sign) {
  std::vector<double> slopes;
  for (std::size_t seed = 0; seed < curve.values.front().size(); ++seed) {
    std::vector<double> y;
    for (const std::vector<double>& row : curve.values) y.push_back(sign * row[seed]);
    slopes.push_back(slope_of(curve.x, y));
  }
  const double seeds = static_cast<double>(slopes.size()), mean = mean_of(slopes);
  if (slopes.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  const double x_mean = mean_of(curve.x);
  double xx = 0.0;
  for (const double x : curve.x) xx += (x - x_mean) * (x - x_mean);
  const auto chance = [mean](double error, double freedom) {
    if (error <= 0.0) return mean > 0.0 ? 0.0 : 1.0;
    return student_tail(mean / error, freedom);
  };
  return std::max(chance(standard_error(slopes), seeds - 1.0),
                  chance(residual.sigma / std::sqrt(seeds * xx), residual.freedom));
}

/// The first step back that is larger than `allowed` (NaN: any is allowed); empty: there is none.
std::string step_back(const Curve& curve, const std::vector<double>& means, double sign, double allowed) {
  for (std::size_t k = 0; k + 1 < means.size(); ++k) {
    const double back = sign * (means[k] - means[k + 1]);
    // A difference in the last digit is not counted as a step back.
    if (back > allowed && back > 1e-9 * std::abs(means[k])) {
      return "from " + short_number(curve.x[k]) + " to " + short_number(curve.x[k + 1]) + " it goes " +
             short_number(back) + " the other way, the seeds explain " + short_number(allowed);
    }
  }
  return "";
}

}  // namespace

Residual residual_of(const Curve& curve) {
  const std::size_t points = curve.values.size(), seeds = curve.values.front().size();
  Residual residual;
  residual.freedom = static_cast<double>((points - 1) * (seeds - 1));
  if (residual.freedom < 1.0) {
    residual.sigma = std::numeric_limits<double>::quiet_NaN();
    return residual;
  }
  std::vector<double> point_means, seed_means(seeds, 0.0);
  for (const std::vector<double>& row : curve.values) {
    point_means.push_back(mean_of(row));
    for (std::size_t s = 0; s < seeds; ++s) seed_means[s] += row[s] / static_cast<double>(points);
  }
  const double mean = mean_of(point_means);
  double sum = 0.0;
  for (std::size_t k = 0; k < points; ++k) {
    for (std::size_t s = 0; s < seeds; ++s) {
      const double rest = curve.values[k][s] - point_means[k] - seed_means[s] + mean;
      sum += rest * rest;
    }
  }
  residual.sigma = std::max(std::sqrt(sum / residual.freedom), curve.resolution / std::sqrt(12.0));
  return residual;
}

namespace {

/// The means over the seeds and how they change, not tested yet.
Trend untested(const Curve& curve) {
  Trend trend;
  for (const std::vector<double>& row : curve.values) trend.means.push_back(mean_of(row));
  trend.change = trend.means.back() - trend.means.front();
  trend.slope = slope_of(curve.x, trend.means);
  return trend;
}

/// Standard error of the difference of two means over the seeds.
double error_of_difference(const Curve& curve, const Residual& residual) {
  return residual.sigma * std::sqrt(2.0 / static_cast<double>(curve.values.front().size()));
}

}  // namespace

Trend check_trend(const Curve& curve, bool falling) {
  const double sign = falling ? -1.0 : 1.0;
  const std::string direction = falling ? "fall" : "rise";
  Trend trend = untested(curve);
  const Residual residual = residual_of(curve);
  trend.p = slope_chance(curve, residual, sign);
  trend.tolerance = std::isnan(residual.sigma)
                        ? residual.sigma
                        : student_quantile(0.025, residual.freedom) * error_of_difference(curve, residual);
  if (!(sign * trend.change > 0.0)) {
    trend.violation =
        "it does not " + direction + " from first to last: the mean changes by " + short_number(trend.change);
  } else if (!(sign * trend.slope > 0.0)) {
    trend.violation =
        "the line through the means does not " + direction + ": its slope is " + short_number(trend.slope);
  } else {
    trend.violation = step_back(curve, trend.means, sign, trend.tolerance);
  }
  return trend;
}

Trend check_limit(const Curve& curve, bool falling, double by) {
  const double sign = falling ? -1.0 : 1.0;
  Trend trend = untested(curve);
  const Residual residual = residual_of(curve);
  const double error = error_of_difference(curve, residual);
  trend.tolerance = by;
  trend.p = 0.0;
  for (std::size_t k = 1; k < trend.means.size(); ++k) {
    const double change = sign * (trend.means[k] - trend.means.front());
    const double chance = error > 0.0 ? student_tail((by - change) / error, residual.freedom) : 0.0;
    trend.p = std::isnan(error) ? error : std::max(trend.p, chance);
    if (change < by || !trend.violation.empty()) continue;
    trend.violation = "from " + short_number(curve.x.front()) + " to " + short_number(curve.x[k]) + " it " +
                      (falling ? "falls" : "rises") + " by " + short_number(change) + ", at most " +
                      short_number(by) + " is expected";
  }
  return trend;
}

namespace {

/// Only the seeds that gave the metric at every point, as logarithms if that is how it is compared.
Curve paired(const SliceValues& slice, bool log_scale, double resolution) {
  Curve curve;
  curve.x = slice.x;
  curve.resolution = resolution;
  curve.values.resize(slice.x.size());
  for (std::size_t seed = 0; seed < slice.values.front().size(); ++seed) {
    const bool whole = std::ranges::all_of(slice.values, [&](const std::vector<double>& row) {
      return std::isfinite(row[seed]) && (!log_scale || row[seed] > 0.0);
    });
    if (!whole) continue;
    for (std::size_t k = 0; k < curve.x.size(); ++k)
      curve.values[k].push_back(log_scale ? std::log(slice.values[k][seed]) : slice.values[k][seed]);
  }
  return curve;
}

Curve times_x(Curve curve, bool log_scale) {
  for (std::size_t k = 0; k < curve.x.size(); ++k)
    for (double& value : curve.values[k])
      value = log_scale ? value + std::log(curve.x[k]) : value * curve.x[k];
  // The coarsest of the products, so that the tolerance rather errs on the side of chance.
  curve.resolution *= *std::ranges::max_element(curve.x);
  return curve;
}

std::string list_of(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) append_to_list(text, short_number(value));
  return text;
}

Trend tested(const Curve& curve, const config::Expectation& expectation) {
  switch (expectation.shape) {
    case config::Shape::kDoesNotRise:
      return check_limit(curve, false, expectation.by);
    case config::Shape::kDoesNotFall:
      return check_limit(curve, true, expectation.by);
    case config::Shape::kRises:
      return check_trend(curve, false);
    case config::Shape::kFalls:
    case config::Shape::kFallsLessThanLinearly:
      break;
  }
  return check_trend(curve, true);
}

/// Tests one trend and, for falls_less_than_linearly, the one of the metric times x.
void test_trend(ShapeCheck& check, const Curve& curve, bool log_scale) {
  const Trend trend = tested(curve, check.expectation);
  check.means = trend.means;
  if (log_scale)
    for (double& mean : check.means) mean = std::exp(mean);
  check.change = log_scale ? std::exp(trend.change) : trend.change;
  check.p = trend.p;
  check.tolerance = trend.tolerance;
  std::string violation = trend.violation;
  if (violation.empty() && check.expectation.shape == config::Shape::kFallsLessThanLinearly) {
    const Trend shares = check_trend(times_x(curve, log_scale), false);
    if (!shares.holds())
      violation = "it falls as fast as 1/" + check.expectation.over + " or faster; times " +
                  check.expectation.over + ", " + shares.violation;
    check.p = std::isnan(shares.p) ? shares.p : std::max(check.p, shares.p);
  }
  const std::string measured = "means " + list_of(check.means);
  const std::string scale = log_scale ? " (of logarithms)" : "";
  if (!violation.empty()) {
    check.verdict = Verdict::kViolated;
    check.detail = violation + scale + "; " + measured;
  } else {
    check.verdict = check.p <= 0.05 ? Verdict::kHolds : Verdict::kHoldsWeakly;
    check.detail = measured;
  }
  check.detail += std::isnan(check.p) ? "; one seed says nothing of chance" : "; p " + short_number(check.p);
}

void check_slice(ShapeCheck& check, const config::ExperimentConfig& config, const config::Study& study,
                 const std::vector<CaseRecord>& records, std::size_t axis, const Slice& slice) {
  const config::MetricSpec* metric = config.metric(check.expectation.metric);
  const bool log_scale = metric && metric->log_scale;
  const Curve curve = paired(values_along(study, records, axis, slice, check.expectation.metric), log_scale,
                             metric ? metric->resolution : 0.0);
  check.x = curve.x;
  check.seeds = curve.values.front().size();
  check.seeds_planned = study.seeds.size();
  if (check.seeds == 0 || curve.x.size() < 2) {
    check.detail = "no seed gave it at every point";
    return;
  }
  test_trend(check, curve, log_scale);
  if (check.seeds < check.seeds_planned) {
    check.detail += "; only " + std::to_string(check.seeds) + " of " + std::to_string(check.seeds_planned) +
                    " seeds gave it at every point";
  }
}

}  // namespace

const char* to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::kHolds:
      return "holds";
    case Verdict::kHoldsWeakly:
      return "holds_weakly";
    case Verdict::kViolated:
      return "violated";
    case Verdict::kNoData:
      return "no_data";
  }
  return "";
}

std::vector<ShapeCheck> check_shapes(const config::ExperimentConfig& config,
                                     const std::vector<CaseRecord>& records) {
  std::vector<ShapeCheck> checks;
  for (const config::Study& study : config.studies) {
    for (const config::Expectation& expectation : study.expectations) {
      const auto axis = std::ranges::find(study.axes, expectation.over, &config::Axis::name);
      if (axis == study.axes.end()) continue;
      const auto index = static_cast<std::size_t>(axis - study.axes.begin());
      for (const Slice& slice : slices(study, index)) {
        ShapeCheck check;
        check.study = study.name;
        check.expectation = expectation;
        check.at = slice.name;
        check_slice(check, config, study, records, index, slice);
        checks.push_back(std::move(check));
      }
    }
  }
  return checks;
}

}  // namespace fleetmap::experiment
