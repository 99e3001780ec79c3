#pragma once

#include <filesystem>
#include <vector>

#include "registration/pair_worlds.hpp"

namespace fleetmap::registration::testing {

/// Nodes with their points in a file of this machine's byte order.
void write_nodes(const std::filesystem::path& path, const std::vector<MappedNode>& nodes);
/// Empty if there is no such file.
std::vector<MappedNode> read_nodes(const std::filesystem::path& path);

}  // namespace fleetmap::registration::testing
