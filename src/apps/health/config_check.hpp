#pragma once

#include <iosfwd>

#include "check_options.hpp"
#include "command_result.hpp"

namespace fleetmap::apps {

/// Prints to `out` what the file is, or what is heard on the radios of its robot; kFailed if that is not as
/// the file says.
CommandResult<ExitCode> check_config(const CheckOptions& options, std::ostream& out);

}  // namespace fleetmap::apps
