#pragma once

#include <iosfwd>

#include "command_result.hpp"
#include "map_options.hpp"

namespace fleetmap::apps {

/// Each opens the store, places its nodes and prints or writes what `fleetmap map` is asked for; a sentence
/// on what was written goes to `out`.

/// Counts, origin and frames; or, as JSON, what scripts compare, for which an empty store has a summary, too.
CommandResult<ExitCode> print_map_info(const MapOptions& options, std::ostream& out);
/// LAS, PLY or PCD.
CommandResult<ExitCode> write_map(const MapOptions& options, std::ostream& out);
/// GPX or GeoJSON.
CommandResult<ExitCode> write_tracks(const MapOptions& options, std::ostream& out);
/// g2o.
CommandResult<ExitCode> write_graph(const MapOptions& options, std::ostream& out);
/// PNG files, whose names are printed.
CommandResult<ExitCode> draw_map(const MapOptions& options, std::ostream& out);

}  // namespace fleetmap::apps
