#include "config_check.hpp"

#include <ostream>
#include <vector>

#include "config_description.hpp"
#include "fleetmap/config/file_kind.hpp"
#include "fleetmap/config/robot_file.hpp"
#include "network_check.hpp"
#include "options.hpp"

namespace fleetmap::apps {
namespace {

CommandResult<ExitCode> check_radios(const CheckOptions& options,
                                     const std::vector<config::Override>& overrides, std::ostream& out) {
  const auto kind = config::check(options.file, overrides);
  if (!kind) return exit_with(kBadConfiguration, kind.error());
  if (*kind != config::FileKind::kRobot)
    return exit_with(kUsage, {options.file + ": --network needs the file of one robot"});
  const auto robot = config::load_robot(options.file, overrides);
  if (!robot) return exit_with(kBadConfiguration, robot.error());
  if (options.radios.domains.first > options.radios.domains.second)
    return exit_with(kUsage, {"--domains: the first must not be above the last"});
  const auto fine = check_network(*robot, options.radios, out);
  if (!fine) return exit_with(kFailed, fine.error());
  return *fine ? kDone : kFailed;
}

}  // namespace

CommandResult<ExitCode> check_config(const CheckOptions& options, std::ostream& out) {
  const auto overrides = parse_overrides(options.set);
  if (!overrides) return exit_with(kUsage, overrides.error());
  if (options.network) return check_radios(options, *overrides, out);
  const auto checked = describe_config(options.file, *overrides, options.agents);
  if (!checked) return exit_with(kBadConfiguration, checked.error());
  out << options.file << ": " << *checked << '\n';
  return kDone;
}

}  // namespace fleetmap::apps
