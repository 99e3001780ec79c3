#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace fleetmap::fault_injection {

/// Random numbers of one stream of a seed (SplitMix64), the same on every machine and in every library.
class Draws {
 public:
  Draws(std::uint64_t seed, std::uint64_t stream) : state_(mixed(seed ^ mixed(stream + kStep))) {}

  std::uint64_t bits() { return mixed(state_ += kStep); }
  /// [0, 1)
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
  double between(double low, double high) { return low + (high - low) * uniform(); }
  /// [0, n), and 0 for an n of 0.
  std::size_t below(std::size_t n) { return n == 0 ? 0 : static_cast<std::size_t>(bits() % n); }
  bool chance(double probability) { return uniform() < probability; }
  /// Box-Muller, standard deviation 1.
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15u;
  static std::uint64_t mixed(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  std::uint64_t state_;
};

}  // namespace fleetmap::fault_injection
