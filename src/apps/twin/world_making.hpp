#pragma once

#include <iosfwd>

#include "command_result.hpp"
#include "world_options.hpp"

namespace fleetmap::apps {

/// Makes the world of a file, describes it on `out` and writes its files.
CommandResult<ExitCode> make_world(const WorldOptions& options, std::ostream& out);

}  // namespace fleetmap::apps
