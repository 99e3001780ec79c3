#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "fleetmap/config/robot_file.hpp"
#include "fleetmap/core/cpu_time.hpp"
#include "fleetmap/odometry/loam.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "fleetmap/recording/play_times.hpp"
#include "fleetmap/recording/reader.hpp"
#include "odometry_run.hpp"
#include "odometry_summary.hpp"
#include "options.hpp"

namespace fleetmap::apps {
namespace {

struct OdometryOptions {
  std::string recording;
  std::string config;
  std::string out;
  std::vector<std::string> set;
};

int run(const OdometryOptions& options) {
  const auto overrides = parse_overrides(options.set);
  if (!overrides) return report(overrides.error(), kUsage);
  std::optional<std::filesystem::path> file;
  if (!options.config.empty()) file = options.config;
  const auto config = config::load_sensors(file, *overrides);
  if (!config) return report(config.error(), kBadConfiguration);
  const recording::ReaderConfig reader_config =
      config->recording ? config->recording->reader : recording::ReaderConfig{};
  const std::filesystem::path folder = std::filesystem::path(options.out).parent_path();
  if (const Status writable = check_writable(folder.empty() ? "." : folder); !writable)
    return report(writable.error(), kFailed);
  auto reader = recording::open(options.recording, reader_config);
  if (!reader) return report(reader.error(), kFailed);
  const auto log_clock = recording::find_log_clock(options.recording, reader_config);
  if (!log_clock) return report(log_clock.error(), kFailed);
  const auto done = run_odometry(**reader, *log_clock, config->agent.perception);
  if (!done) return report(done.error(), kFailed);
  if (done->poses.empty()) {
    return report({options.recording + ": no scan could be used" +
                   (done->first_refusal.empty() ? "" : ": " + done->first_refusal)},
                  kFailed);
  }
  if (const Status written = output::write_tum(options.out, done->poses); !written)
    return report(written.error(), kFailed);
  print_summary(std::cout, *done);
  for (const auto& [name, count] : (*reader)->counters().named()) {
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
  command
      ->add_option("recording", options->recording,
                   "rosbag2 folder or .db3, KITTI folder, or a folder of scans")
      ->required();
  command->add_option("--out", options->out, "TUM file")->required()->check(some_path());
  command->add_option("-c,--config", options->config, "AGENT.yaml or FLEET.yaml for the sensors");
  command->add_option("--set", options->set, "key=value, e.g. lidar.model=hdl64e")->allow_extra_args(false);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace fleetmap::apps
