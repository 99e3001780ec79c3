#pragma once

#include <tl/expected.hpp>
#include <utility>

#include "fleetmap/core/result.hpp"

namespace fleetmap::apps {

/// Exit codes that scripts rely on.
enum ExitCode : int { kDone = 0, kFailed = 1, kUsage = 2, kBadConfiguration = 78 };

/// Why a command ends early, and the code that it exits with.
struct CommandError {
  Error error;
  ExitCode code = kFailed;
};

template <class T>
using CommandResult = tl::expected<T, CommandError>;

inline tl::unexpected<CommandError> exit_with(ExitCode code, Error error) {
  return tl::unexpected<CommandError>(CommandError{std::move(error), code});
}

/// The exit code of a command that has ended; its error goes to standard error.
int report(const CommandResult<ExitCode>& result);

}  // namespace fleetmap::apps
