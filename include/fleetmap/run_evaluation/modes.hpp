#pragma once

#include <set>
#include <span>
#include <string>

#include "fleetmap/graph/compute_placement.hpp"
#include "fleetmap/registration/registration_config.hpp"

namespace fleetmap::run_evaluation {

/// One way to make a map of a run: a registration method and a placement method.
struct Mode {
  const char* name;
  registration::Method registration;
  graph::PlacementMethod placement;
};

/// All combinations:
///   paper              the paper's registration and its placement (mode `paper`)
///   correlation_paper  the correlative registration, the paper's placement
///   paper_graph        the paper's registration, the fleet's graph
///   fleet              the correlative registration, the fleet's graph (mode `fleet`)
std::span<const Mode> modes();

std::set<std::string> mode_names();

}  // namespace fleetmap::run_evaluation
