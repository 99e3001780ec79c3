#include "recording_odometry.hpp"

#include <spdlog/spdlog.h>

#include <filesystem>
#include <ostream>
#include <string>

#include "fleetmap/output/trajectory_file.hpp"
#include "odometry_run.hpp"
#include "odometry_summary.hpp"
#include "options.hpp"
#include "recording_input.hpp"
#include "unread_parts.hpp"

namespace fleetmap::apps {

CommandResult<ExitCode> trace_recording(const OdometryOptions& options, std::ostream& out) {
  const std::filesystem::path folder = std::filesystem::path(options.out).parent_path();
  if (const Status writable = check_writable(folder.empty() ? "." : folder); !writable)
    return exit_with(kFailed, writable.error());
  const auto input = open_recording(options.input);
  if (!input) return tl::unexpected(input.error());
  log_preparation(input->prepared);
  const auto done = run_odometry(*input->reader, input->prepared.log_clock, input->config.agent.perception);
  if (!done) return exit_with(kFailed, done.error());
  for (const std::string& finding : done->findings) spdlog::warn("{}", finding);
  if (done->poses.empty()) {
    return exit_with(kFailed, {options.input.recording + ": no scan could be used" +
                               (done->first_refusal.empty() ? "" : ": " + done->first_refusal)});
  }
  if (const Status written = output::write_tum(options.out, done->poses); !written)
    return exit_with(kFailed, written.error());
  print_summary(out, *done);
  for (const auto& [name, count] : input->reader->counters().named()) {
    if (count > 0) out << name << ' ' << count << '\n';
  }
  print_losses(out, *done);
  const std::vector<std::string> unread = unread_parts(input->reader->counters());
  for (const std::string& part : unread) out << part << '\n';
  if (!done->kept_its_way())
    return exit_with(kFailed, {"the odometry lost its way; the trajectory is not to be relied on"});
  return is_damaged(input->reader->counters()) ? kFailed : kDone;
}

}  // namespace fleetmap::apps
