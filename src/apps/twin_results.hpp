#pragma once

#include <filesystem>
#include <vector>

#include "fleetmap/agent/trajectory_file.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/sim/world.hpp"

namespace fleetmap::apps {

/// `directory`/truth.tum: where a robot of the twin really was, base_link in ENU.
Status write_truth(const std::filesystem::path& directory, const std::vector<agent::StampedPose>& truth);

/// `out`/truth.ply: points spread evenly over every surface of the world, as dense as fits some million
/// points.
Status write_truth_cloud(const std::filesystem::path& out, const sim::World& world);

}  // namespace fleetmap::apps
