#pragma once

/// Student's t by Boost.Math; NaN where an argument is.
namespace fleetmap::experiment {

/// One-sided chance that Student's t with `freedom` >= 1 degrees of freedom exceeds `t`.
double student_tail(double t, double freedom);
/// The t that is exceeded with the chance `tail` in (0, 0.5).
double student_quantile(double tail, double freedom);

}  // namespace fleetmap::experiment
