#include "fleetmap/sim/terrain.hpp"

#include <cmath>
#include <numbers>

#include "counter_random.hpp"

namespace fleetmap::sim {
namespace {

/// Value and derivatives with respect to x and y.
using Jet = Eigen::Vector3d;

constexpr double kNoiseDeviation = 0.25;  // standard deviation of the noise below

/// 0 to 1 for t from 0 to 1, with two derivatives that vanish at both ends; and its derivative.
double fade(double t) { return t * t * t * (t * (6.0 * t - 15.0) + 10.0); }
double fade_slope(double t) { return 30.0 * t * t * (t - 1.0) * (t - 1.0); }

/// The plane of the lattice point (i, j): 0 there, of a random direction.
Eigen::Vector2d lattice_gradient(std::uint64_t seed, std::int64_t i, std::int64_t j) {
  const double angle =
      2.0 * std::numbers::pi * uniform_at(seed, static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(j));
  return {std::cos(angle), std::sin(angle)};
}

/// Gradient noise with a lattice of one unit.
Jet gradient_noise(std::uint64_t seed, double x, double y) {
  const double floor_x = std::floor(x), floor_y = std::floor(y);
  const auto i = static_cast<std::int64_t>(floor_x), j = static_cast<std::int64_t>(floor_y);
  const double u = x - floor_x, v = y - floor_y;
  Jet sum = Jet::Zero();
  for (int corner = 0; corner < 4; ++corner) {
    const int di = corner & 1, dj = corner >> 1;
    const Eigen::Vector2d g = lattice_gradient(seed, i + di, j + dj);
    const double plane = g.x() * (u - di) + g.y() * (v - dj);
    const double wx = di == 1 ? fade(u) : 1.0 - fade(u);
    const double wy = dj == 1 ? fade(v) : 1.0 - fade(v);
    const double wx_slope = di == 1 ? fade_slope(u) : -fade_slope(u);
    const double wy_slope = dj == 1 ? fade_slope(v) : -fade_slope(v);
    sum += Jet(wx * wy * plane, wx * wy * g.x() + wx_slope * wy * plane,
               wx * wy * g.y() + wx * wy_slope * plane);
  }
  return sum;
}

/// Two octaves: hills, and half as wide, a third as high.
Jet relief(std::uint64_t seed, double amplitude, double wavelength, double x, double y) {
  if (amplitude == 0.0) return Jet::Zero();
  Jet sum = Jet::Zero();
  double height = amplitude / kNoiseDeviation / 1.054;  // sqrt(1 + 1/9)
  double width = 0.5 * wavelength;                      // a hill and a valley take two lattice units
  for (std::uint64_t octave = 0; octave < 2; ++octave) {
    const Jet noise = gradient_noise(mixed(seed + octave), x / width, y / width);
    sum += height * Jet(noise[0], noise[1] / width, noise[2] / width);
    height /= 3.0;
    width /= 2.0;
  }
  return sum;
}

Jet jet(const TerrainConfig& c, std::uint64_t seed, double x, double y) {
  const double east = std::tan(c.slope_east_rad), north = std::tan(c.slope_north_rad);
  return relief(mixed(seed ^ 0x9011), c.rolling_amplitude, c.rolling_wavelength, x, y) +
         relief(mixed(seed ^ 0x9012), c.rough_amplitude, c.rough_wavelength, x, y) +
         Jet(east * x + north * y, east, north);
}

}  // namespace

double Terrain::height(double x, double y) const { return jet(config_, seed_, x, y)[0]; }

Eigen::Vector2d Terrain::gradient(double x, double y) const { return jet(config_, seed_, x, y).tail<2>(); }

}  // namespace fleetmap::sim
