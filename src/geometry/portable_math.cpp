#include "fleetmap/geometry/portable_math.hpp"

#include <sleef.h>

// "cinz" are those functions that SLEEF promises the same results of on all processors, without fused
// operations.
namespace fleetmap::portable {

SinCos sin_cos(double radians) {
  const Sleef_double_2 both = Sleef_cinz_sincosd1_u10purec(radians);
  return {both.x, both.y};
}

double tan(double radians) { return Sleef_cinz_tand1_u10purec(radians); }

double asin(double x) { return Sleef_cinz_asind1_u10purec(x); }

double atan2(double y, double x) { return Sleef_cinz_atan2d1_u10purec(y, x); }

double exp(double x) { return Sleef_cinz_expd1_u10purec(x); }

double exp2(double x) { return Sleef_cinz_exp2d1_u10purec(x); }

double log(double x) { return Sleef_cinz_logd1_u10purec(x); }

double log2(double x) { return Sleef_cinz_log2d1_u10purec(x); }

}  // namespace fleetmap::portable
