#include "fleetmap/run_evaluation/modes.hpp"

#include <array>

namespace fleetmap::run_evaluation {
namespace {

constexpr std::array kModes{
    Mode{"paper", registration::Method::paper, graph::PlacementMethod::paper},
    Mode{"correlation_paper", registration::Method::correlation, graph::PlacementMethod::paper},
    Mode{"paper_graph", registration::Method::paper, graph::PlacementMethod::graph},
    Mode{"fleet", registration::Method::correlation, graph::PlacementMethod::graph},
};

}  // namespace

std::span<const Mode> modes() { return kModes; }

std::set<std::string> mode_names() {
  std::set<std::string> names;
  for (const Mode& mode : kModes) names.insert(mode.name);
  return names;
}

}  // namespace fleetmap::run_evaluation
