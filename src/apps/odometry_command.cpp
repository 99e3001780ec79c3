#include <spdlog/spdlog.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include "commands.hpp"
#include "fleetmap/core/cpu_time.hpp"
#include "fleetmap/odometry/loam.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "odometry_run.hpp"
#include "odometry_summary.hpp"
#include "options.hpp"
#include "recording_input.hpp"

namespace fleetmap::apps {
namespace {

struct OdometryOptions {
  RecordingOptions input;
  std::string out;
};

int run(const OdometryOptions& options) {
  const std::filesystem::path folder = std::filesystem::path(options.out).parent_path();
  if (const Status writable = check_writable(folder.empty() ? "." : folder); !writable)
    return report(writable.error(), kFailed);
  const auto input = open_recording(options.input);
  if (!input) return input.error();
  for (const std::string& mount : input->prepared.mounts) spdlog::info("{}", mount);
  for (const std::string& finding : input->prepared.findings) spdlog::warn("{}", finding);
  const auto done = run_odometry(*input->reader, input->prepared.log_clock, input->config.agent.perception);
  if (!done) return report(done.error(), kFailed);
  for (const std::string& finding : done->findings) spdlog::warn("{}", finding);
  if (done->poses.empty()) {
    return report({options.input.recording + ": no scan could be used" +
                   (done->first_refusal.empty() ? "" : ": " + done->first_refusal)},
                  kFailed);
  }
  if (const Status written = output::write_tum(options.out, done->poses); !written)
    return report(written.error(), kFailed);
  print_summary(std::cout, *done);
  for (const auto& [name, count] : input->reader->counters().named()) {
    if (count > 0) std::cout << name << ' ' << count << '\n';
  }
  print_losses(std::cout, *done);
  if (!done->kept_its_way())
    return report({"the odometry lost its way; the trajectory is not to be relied on"}, kFailed);
  return kDone;
}

}  // namespace

void add_odometry(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<OdometryOptions>();
  CLI::App* command =
      app.add_subcommand("odometry", "odometry alone: a recording in, a TUM trajectory of base_link out");
  add_recording_options(*command, options->input);
  command->add_option("--out", options->out, "TUM file")->required()->check(some_path());
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace fleetmap::apps
