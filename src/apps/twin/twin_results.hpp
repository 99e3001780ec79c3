#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "fleetmap/sim/world.hpp"
#include "twin_setup.hpp"

namespace fleetmap::apps {

/// `directory`/truth.tum: where a robot of the twin really was, base_link in ENU.
Status write_truth(const std::filesystem::path& directory, const output::Trajectory& truth);

/// `out`/truth.ply: points spread evenly over every surface of the world, as dense as fits some million
/// points.
Status write_truth_cloud(const std::filesystem::path& out, const sim::World& world);

/// `out`/site.geojson: the drawing that the fleet planned on.
Status write_site(const std::filesystem::path& out, const TwinSetup& setup);

/// Share of the length of each `every`-th lane of the world that some robot truly drove: it was within 5 m of
/// it and nearer to it than to any other lane. Nothing for a world without lanes.
std::optional<double> share_of_lanes_driven(const sim::World& world, int every,
                                            const std::vector<output::Trajectory>& truths);

}  // namespace fleetmap::apps
