#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "fleetmap/monitor/pair_candidates.hpp"

namespace fleetmap::monitor {

/// For the page: whose they are, and the sentence.
nlohmann::json candidates_json(const std::vector<PairCandidates>& all);

}  // namespace fleetmap::monitor
