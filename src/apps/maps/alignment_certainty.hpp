#pragma once

#include <span>

#include "fleetmap/graph/alignment.hpp"

namespace fleetmap::apps {

/// Standard deviations of alignments by their registrations, each along its least certain direction.
struct AlignmentCertainty {
  double median_m = 0.0, largest_m = 0.0;      ///< of the position
  double median_rad = 0.0, largest_rad = 0.0;  ///< of the rotation
};
/// By the best mode of each. All zero without alignments.
AlignmentCertainty certainty_of(std::span<const graph::Alignment> alignments);

}  // namespace fleetmap::apps
