#pragma once

#include <iosfwd>
#include <optional>

#include "command_result.hpp"
#include "fleetmap/registration/register_clouds.hpp"
#include "register_options.hpp"

namespace fleetmap::apps {

/// The prior that the options give, in m and rad.
std::optional<registration::Prior> prior_of(const RegisterOptions& options);

/// Registers the source's file onto the target's, and prints the result to `out` as JSON. A rejected
/// registration is a result, too.
CommandResult<ExitCode> register_files(const RegisterOptions& options, std::ostream& out);

}  // namespace fleetmap::apps
