#pragma once

#include <iosfwd>

#include "command_result.hpp"
#include "doctor_options.hpp"

namespace fleetmap::apps {

/// Listens to a robot's sensors as its agent would, beside it or before it runs. Prints to `out` their
/// streams, their mounts and what is wrong with them or the computer; kFailed if anything is.
CommandResult<ExitCode> examine_sensors(const DoctorOptions& options, std::ostream& out);

}  // namespace fleetmap::apps
