#pragma once

#include "fleetmap/graph/alignment.hpp"

namespace fleetmap::graph {

/// Configuration of the paper's placement (method `paper`).
struct PaperPlacementConfig {
  double max_rmse = kGoodRmse;         ///< m, alignments with a larger E_ij are ignored
  double gps_correlation_time = 60.0;  ///< s, fixes closer in time than this share their error
};

}  // namespace fleetmap::graph
