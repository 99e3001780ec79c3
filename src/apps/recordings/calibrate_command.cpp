#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "commands.hpp"
#include "recording_calibration.hpp"

namespace fleetmap::apps {

void add_calibrate(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CalibrateOptions>();
  CLI::App* command = app.add_subcommand(
      "calibrate",
      "estimates the mounts of LiDAR, IMU and GPS antenna from a recorded drive of two figures of "
      "eight, and prints them with sigmas and as lines of the configuration");
  add_recording_options(*command, options->input);
  command->add_flag("--json", options->json, "prints the result as JSON, with covariances");
  command->callback([options, &exit_code] { exit_code = report(calibrate_recording(*options, std::cout)); });
}

}  // namespace fleetmap::apps
