#pragma once

#include "fleetmap/planning/site/mission.hpp"

namespace fleetmap::planning {

/// Which rows of a site are driven and how they are cut.
struct RowSelection {
  int every = 1;                ///< each `every`-th row, from the first
  double max_row_length = 0.0;  ///< m; longer rows are cut, so that few can be divided. 0: no cut
};

/// Keeps each `every`-th row and cuts rows into equal pieces along their length; the pieces of every second
/// row that is cut run back, so that they follow each other as one path. Rows keep their ids unless one is
/// cut; then all are numbered anew from 0.
Mission with_selected_rows(Mission mission, const RowSelection& selection);

}  // namespace fleetmap::planning
