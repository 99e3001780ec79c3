#pragma once

/// Functions that give the same bits on every processor, unlike those of the C library, whose last digit
/// differs between x86 and ARM. Decoding and placement use these, because all robots must compute the same
/// result from the same items. Errors below 1 ulp; NaN and infinities as in <cmath>. (SLEEF, its functions of
/// consistent results.)
namespace fleetmap::portable {

/// Sine and cosine of one angle.
struct SinCos {
  double sin = 0.0;
  double cos = 1.0;
};

SinCos sin_cos(double radians);
double tan(double radians);
double asin(double x);             ///< rad, [-pi/2, pi/2]
double atan2(double y, double x);  ///< rad, [-pi, pi]
double exp(double x);
double exp2(double x);
double log(double x);
double log2(double x);

}  // namespace fleetmap::portable
