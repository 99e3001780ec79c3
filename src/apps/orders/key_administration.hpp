#pragma once

#include <iosfwd>

#include "command_result.hpp"
#include "keys_options.hpp"

namespace fleetmap::apps {

/// Each changes or shows the operator's folder of keys by the clock of this computer, and prints to `out`
/// what a person does next.
CommandResult<ExitCode> make_fleet_keys(const KeysOptions& options, std::ostream& out);
CommandResult<ExitCode> add_member(const KeysOptions& options, std::ostream& out);
CommandResult<ExitCode> revoke_member(const KeysOptions& options, std::ostream& out);
CommandResult<ExitCode> list_members(const KeysOptions& options, std::ostream& out);

}  // namespace fleetmap::apps
