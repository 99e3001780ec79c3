#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <string>

namespace fleetmap::testing {

/// Number of seeds, from 1, that a test with measured bounds runs: `usual`, or FLEETMAP_SEEDS of the
/// environment. With that variable every value is printed, so that bounds can be measured anew
/// (docs/reference/test_bounds.md).
inline unsigned seeds_to_run(unsigned usual) {
  const char* seeds = std::getenv("FLEETMAP_SEEDS");
  return seeds != nullptr ? static_cast<unsigned>(std::strtoul(seeds, nullptr, 10)) : usual;
}

inline void print_measured(const std::string& what, unsigned seed, double value) {
  if (std::getenv("FLEETMAP_SEEDS") == nullptr) return;
  std::printf("measured %s, seed %u: %.5g\n", what.c_str(), seed, value);
  std::fflush(stdout);
}

inline void expect_at_most(double value, double bound, const std::string& what, unsigned seed) {
  print_measured(what, seed, value);
  EXPECT_LE(value, bound) << what << ", seed " << seed;
}

inline void expect_at_least(double value, double bound, const std::string& what, unsigned seed) {
  print_measured(what, seed, value);
  EXPECT_GE(value, bound) << what << ", seed " << seed;
}

}  // namespace fleetmap::testing
