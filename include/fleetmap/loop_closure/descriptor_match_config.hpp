#pragma once

#include <cstddef>

#include "fleetmap/core/result.hpp"

namespace fleetmap::loop_closure {

/// When the descriptors of two nodes match.
struct DescriptorMatchConfig {
  double spacing_m = 8.0;          ///< m along a track between the nodes that are compared
  double min_similarity = 0.35;    ///< of a pair that may be a candidate, [0, 1]
  double sure_similarity = 0.5;    ///< a pair this similar needs no support
  double min_support = 1.0;        ///< else: summed similarity of other matches with the same frame transform
  double agree_m = 5.0;            ///< m, and
  double agree_rad = 0.25;         ///< rad, within which two matches imply the same frame transform
  std::size_t kept = 5;            ///< matches of one node that may support others
  std::size_t max_compared = 200;  ///< nodes of one other agent; those with the most similar occupied area
  Status validate() const;
};

}  // namespace fleetmap::loop_closure
