#include "fleetmap/eval/colours.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace fleetmap::eval {
namespace {

constexpr Rgb kUnknown{128, 128, 128};

/// A polynomial of degree 6 for each of red, green and blue.
using Polynomials = std::array<std::array<double, 3>, 7>;

// Fitted to matplotlib's table by M. Zucker (public domain).
constexpr Polynomials kViridis{{{0.2777273272234177, 0.005407344544966578, 0.3340998053353061},
                                {0.1050930431085774, 1.404613529898575, 1.384590162594685},
                                {-0.3308618287255563, 0.214847559468213, 0.09509516302823659},
                                {-4.634230498983486, -5.799100973351585, -19.33244095627987},
                                {6.228269936347081, 14.17993336680509, 56.69055260068105},
                                {4.776384997670288, -13.74514537774601, -65.35303263337234},
                                {-5.435455855934631, 4.645852612178535, 26.3124352495832}}};
// Coefficients from A. Mikhailov's polynomial fit of Turbo (Apache-2.0).
constexpr Polynomials kTurbo{{{0.13572138, 0.09140261, 0.10667330},
                              {4.61539260, 2.19418839, 12.64194608},
                              {-42.66032258, 4.84296658, -60.58204836},
                              {132.13108234, -14.18503333, 110.36276771},
                              {-152.94239396, 4.27729857, -89.90310912},
                              {59.28637943, 2.82956604, 27.34824973},
                              {0.0, 0.0, 0.0}}};

Rgb evaluate(const Polynomials& c, double share) {
  if (!std::isfinite(share)) return kUnknown;
  const double x = std::clamp(share, 0.0, 1.0);
  std::array<std::uint8_t, 3> rgb{};
  for (std::size_t k = 0; k < 3; ++k) {
    double value = 0.0;
    for (std::size_t degree = c.size(); degree-- > 0;) value = value * x + c[degree][k];
    rgb[k] = static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(value, 0.0, 1.0)));
  }
  return {rgb[0], rgb[1], rgb[2]};
}

}  // namespace

Rgb viridis(double share) { return evaluate(kViridis, share); }
Rgb turbo(double share) { return evaluate(kTurbo, share); }

Rgb robot_colour(std::size_t robot) {
  static constexpr std::array<Rgb, 7> kOkabeIto{{{86, 180, 233},
                                                 {230, 159, 0},
                                                 {0, 158, 115},
                                                 {204, 121, 167},
                                                 {240, 228, 66},
                                                 {213, 94, 0},
                                                 {0, 114, 178}}};
  return kOkabeIto[robot % kOkabeIto.size()];
}

std::string hex(Rgb colour) {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", colour.r, colour.g, colour.b);
  return text.data();
}

}  // namespace fleetmap::eval
