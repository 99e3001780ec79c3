#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace fleetmap::apps {

/// Fleets of random faults, as the command line has them.
struct FuzzOptions {
  std::uint64_t seeds = 100;
  std::uint64_t from = 1;
  std::optional<std::uint64_t> replay;  ///< this seed alone
  std::vector<std::size_t> keep;        ///< with `replay`: numbers of the faults that happen; empty: all
  std::string stores;                   ///< with `replay`: folder of the robots' stores; empty: none
  std::vector<std::size_t> robots;      ///< so many, or between the least and the largest; empty: the default
  std::string faults = "all";           ///< kinds, separated by commas
  std::string invariants = "all";       ///< those that are checked, separated by commas
  double mapping = 150.0;               ///< s
  unsigned jobs = std::max(1u, std::thread::hardware_concurrency());
  bool no_shrink = false;
  bool signatures = false;
};

}  // namespace fleetmap::apps
