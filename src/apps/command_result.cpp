#include "command_result.hpp"

#include <iostream>

namespace fleetmap::apps {

int report(const CommandResult<ExitCode>& result) {
  if (result) return *result;
  std::cerr << result.error().error.message << '\n';
  return result.error().code;
}

}  // namespace fleetmap::apps
