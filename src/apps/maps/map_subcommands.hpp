#pragma once

namespace CLI {
class App;
}

namespace fleetmap::apps {

/// Each adds its subcommand of map; when it is chosen, its exit code goes to `exit_code`.
void add_map_merge(CLI::App& map, int& exit_code);
void add_map_diff(CLI::App& map, int& exit_code);

}  // namespace fleetmap::apps
