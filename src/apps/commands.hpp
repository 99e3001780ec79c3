#pragma once

namespace CLI {
class App;
}

namespace fleetmap::apps {

/// Each adds its subcommand; when it is chosen, its exit code goes to `exit_code`.
void add_run(CLI::App& app, int& exit_code);
void add_agent(CLI::App& app, int& exit_code);
/// Four: hold, resume, home and give.
void add_hold(CLI::App& app, int& exit_code);
void add_sim(CLI::App& app, int& exit_code);
void add_replay(CLI::App& app, int& exit_code);
void add_odometry(CLI::App& app, int& exit_code);
void add_inspect(CLI::App& app, int& exit_code);
void add_calibrate(CLI::App& app, int& exit_code);
void add_doctor(CLI::App& app, int& exit_code);
void add_register(CLI::App& app, int& exit_code);
void add_experiment(CLI::App& app, int& exit_code);
void add_trial(CLI::App& app, int& exit_code);
void add_check_config(CLI::App& app, int& exit_code);
void add_map(CLI::App& app, int& exit_code);
void add_world(CLI::App& app, int& exit_code);
void add_plan(CLI::App& app, int& exit_code);
void add_eval(CLI::App& app, int& exit_code);
void add_monitor(CLI::App& app, int& exit_code);
void add_keys(CLI::App& app, int& exit_code);
void add_fuzz_fleet(CLI::App& app, int& exit_code);

}  // namespace fleetmap::apps
