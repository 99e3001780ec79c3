// `fleetmap doctor`: listens to a robot's sensors as its agent would, beside it or before it runs.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "commands.hpp"
#include "sensor_examination.hpp"

namespace fleetmap::apps {

void add_doctor(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<DoctorOptions>();
  CLI::App* command = app.add_subcommand("doctor",
                                         "listens to a robot's sensors and reports errors of clocks, units, "
                                         "rates and mounts; exit code 1 if there are any");
  command->add_option("-c,--config", options->config, "AGENT.yaml")->required();
  command->add_option("--seconds", options->seconds, "s, duration")->check(CLI::PositiveNumber);
  command->add_option("--set", options->set, "key=value")->allow_extra_args(false);
  command->callback([options, &exit_code] { exit_code = report(examine_sensors(*options, std::cout)); });
}

}  // namespace fleetmap::apps
