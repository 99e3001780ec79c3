#pragma once

#include <cstdint>

namespace fleetmap::sim {

/// A well-mixed 64-bit value of `x` (the finalizer of SplitMix64).
inline std::uint64_t mixed(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

/// A random number in [0, 1) that depends on nothing but its arguments: no state, no order of calls.
inline double uniform_at(std::uint64_t seed, std::uint64_t a, std::uint64_t b = 0, std::uint64_t c = 0) {
  const std::uint64_t bits = mixed(mixed(mixed(mixed(seed) ^ a) ^ b) ^ c);
  return static_cast<double>(bits >> 11) * 0x1.0p-53;
}

/// The same in [-1, 1).
inline double signed_at(std::uint64_t seed, std::uint64_t a, std::uint64_t b = 0, std::uint64_t c = 0) {
  return 2.0 * uniform_at(seed, a, b, c) - 1.0;
}

}  // namespace fleetmap::sim
