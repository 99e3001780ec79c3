#pragma once

#include <iosfwd>

#include "command_result.hpp"
#include "recording_options.hpp"

namespace fleetmap::apps {

/// Reads a whole recording and prints to `out` its streams, mounts and what is wrong with them; kFailed if
/// anything is.
CommandResult<ExitCode> inspect_recording(const RecordingOptions& options, std::ostream& out);

}  // namespace fleetmap::apps
