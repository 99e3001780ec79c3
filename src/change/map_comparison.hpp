#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "cell_map.hpp"
#include "fleetmap/change/change_config.hpp"
#include "noise_model.hpp"

namespace fleetmap::change {

/// Cells of one map that the other day saw through, next to each other, with those beside that it did not
/// see.
struct FreeCluster {
  std::vector<Eigen::Vector3f> points;  ///< one a cell
  std::size_t traversed = 0;            ///< the first so many of them
};

/// Cells of a map by what the other day says of them.
struct MapComparison {
  std::vector<Eigen::Vector3f> same, unobserved;
  std::vector<FreeCluster> free;  ///< largest first
  std::size_t traversed = 0;      ///< cells
};

/// Compares the surfaces of `map`, that several of its submaps saw, with the other day.
MapComparison compare(const CellMap& map, const CellMap& other, const NoiseModel& noise,
                      const ChangeConfig& config);

}  // namespace fleetmap::change
