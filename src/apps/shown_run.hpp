#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "fleetmap/core/result.hpp"
#include "fleetmap/monitor/fleet_view.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::apps {

/// A run that its files tell of, finished or not: the view of one robot, and its store, which holds the
/// submaps.
struct ShownRun {
  std::unique_ptr<store::Store> store;
  monitor::FleetView view;
};

/// One robot's store. Fails if it holds no node yet.
Result<ShownRun> open_one(const std::filesystem::path& file);

/// All robots below `directory`, on the map of one: of `robot`, or of the one that holds most if it is empty.
Result<ShownRun> open_run(const std::filesystem::path& directory, const std::string& robot);

}  // namespace fleetmap::apps
