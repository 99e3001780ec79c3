#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "counter_random.hpp"

namespace fleetmap::sim {

/// Uniform in [0, 1) from 16 of 64 random bits, the `part`-th of four.
inline float uniform16(std::uint64_t bits, int part) {
  return static_cast<float>((bits >> (16 * part)) & 0xffff) * 0x1.0p-16f;
}

/// Standard normal value of 64 random bits (Box and Muller).
inline double gaussian(std::uint64_t bits) {
  const double u = (static_cast<double>(bits >> 32) + 0.5) * 0x1.0p-32;
  const double v = static_cast<double>(bits & 0xffffffff) * 0x1.0p-32;
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
}
/// The same in single precision, for one in a million rays a scan.
inline float gaussian_float(std::uint64_t bits) {
  const float u = (static_cast<float>(bits >> 40) + 0.5f) * 0x1.0p-24f;
  const float v = static_cast<float>(bits & 0xffffff) * 0x1.0p-24f;
  return std::sqrt(-2.0f * std::log(u)) * std::cos(2.0f * std::numbers::pi_v<float> * v);
}

/// Random numbers of one source, one after another, the same on every run.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::uint64_t source) : key_(mixed(mixed(seed) ^ source)) {}
  double normal() { return gaussian(next()); }
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }  ///< [0, 1)

 private:
  std::uint64_t next() { return mixed(key_ ^ counter_++); }
  std::uint64_t key_, counter_ = 0;
};

/// First-order Gauss-Markov process in its steady state: zero mean, the given sigma, and a correlation of
/// exp(-dt / time).
class GaussMarkov {
 public:
  GaussMarkov(double sigma, double time) : sigma_(sigma), time_(time) {}
  double next(double dt, RandomStream& random) {
    const double keep = started_ ? std::exp(-dt / time_) : 0.0;
    value_ = keep * value_ + std::sqrt(1.0 - keep * keep) * sigma_ * random.normal();
    started_ = true;
    return value_;
  }

 private:
  double sigma_, time_, value_ = 0.0;
  bool started_ = false;
};

}  // namespace fleetmap::sim
