#pragma once

#include <filesystem>

#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/graph/placement.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::output {

/// alignments.csv: every alignment held, a line for each of its modes.
Status write_alignments(const store::Store& store, const graph::Placement& placement,
                        const std::filesystem::path& file);
/// nodes.csv: every node held, by robot and number: O, G (also in ENU, with its sigmas), and where it is
/// placed.
Status write_nodes(const store::Store& store, const graph::Placement& placement, const LocalFrame& site,
                   const std::filesystem::path& file);

}  // namespace fleetmap::output
