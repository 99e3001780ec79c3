#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <iostream>

#include "command_result.hpp"
#include "commands.hpp"
#include "manual.hpp"
#include "version.hpp"

namespace fleetmap::apps {

namespace {

int run(int argc, char** argv) {
  CLI::App app{"fleetmap: a team of ground robots maps a large site together, without a server", "fleetmap"};
  app.require_subcommand(1);
  app.fallthrough();
  app.option_defaults()->always_capture_default();  // for the help and the man page
  app.set_version_flag("--version", kVersion);
  std::string log_level = "info";
  app.add_option("--log", log_level, "trace, debug, info, warn, error or off")
      ->check(CLI::IsMember({"trace", "debug", "info", "warn", "error", "off"}))
      ->each([](const std::string& level) { spdlog::set_level(spdlog::level::from_str(level)); });
  int exit_code = kDone;
  add_run(app, exit_code);
  add_agent(app, exit_code);
  add_hold(app, exit_code);
  add_sim(app, exit_code);
  add_replay(app, exit_code);
  add_odometry(app, exit_code);
  add_inspect(app, exit_code);
  add_calibrate(app, exit_code);
  add_doctor(app, exit_code);
  add_register(app, exit_code);
  add_map(app, exit_code);
  add_world(app, exit_code);
  add_plan(app, exit_code);
  add_eval(app, exit_code);
  add_experiment(app, exit_code);
  add_trial(app, exit_code);
  add_monitor(app, exit_code);
  add_check_config(app, exit_code);
  add_keys(app, exit_code);
  add_fuzz_fleet(app, exit_code);
  app.add_subcommand("manual", "prints the man page")->callback([&] { std::cout << man_page(app); });
  app.add_subcommand("completion", "prints a script that completes the command line in bash")->callback([&] {
    std::cout << bash_completion(app);
  });
  drop_empty_defaults(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kUsage;
  }
  return exit_code;
}

}  // namespace
}  // namespace fleetmap::apps

int main(int argc, char** argv) {
  // Results go to standard output, and only they.
  spdlog::set_default_logger(spdlog::stderr_color_mt("fleetmap"));
  spdlog::set_pattern("%H:%M:%S.%e %^%l%$ %v");
  try {
    return fleetmap::apps::run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "fleetmap: " << error.what() << '\n';
    return fleetmap::apps::kFailed;
  }
}
