#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/monitor/fleet_view.hpp"
#include "fleetmap/output/results.hpp"
#include "fleetmap/store/store.hpp"
#include "robot_files.hpp"

namespace fleetmap::apps {

/// A run that its files tell of, finished or not: the view of one robot, and its store, which holds the
/// submaps.
struct LoadedRun {
  std::unique_ptr<store::Store> store;
  monitor::FleetView view;
  std::vector<RobotFiles> files;  ///< of each robot, and of the run as a whole
};

/// All that a store holds, placed as its results were.
monitor::FleetView view_of(const store::Store& store, const output::Results& results);
/// Adds the registrations of robot `by`, if registrations.csv is in its folder.
void add_attempts(const std::filesystem::path& folder, const AgentId& by, monitor::FleetView& view);

/// One robot's store, but for the items of robots `without`. Fails if it holds no node yet, or nothing of one
/// of these.
Result<LoadedRun> open_one(const std::filesystem::path& file, std::span<const AgentId> without = {});

/// The stores of all robots below `directory`.
std::vector<std::filesystem::path> robot_stores(const std::filesystem::path& directory);

/// All robots below `directory`, on the map of one: of `robot`, or of the one that holds most if it is empty.
/// Fails as open_one().
Result<LoadedRun> open_run(const std::filesystem::path& directory, const std::string& robot,
                           std::span<const AgentId> without = {});

}  // namespace fleetmap::apps
