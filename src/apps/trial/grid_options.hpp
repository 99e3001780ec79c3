#pragma once

#include <algorithm>
#include <string>
#include <thread>
#include <vector>

namespace CLI {
class App;
}

namespace fleetmap::apps {

/// Options shared by the commands that run a grid of cases: `experiment` in the twin, `trial` on network
/// interfaces.
struct GridOptions {
  std::string config;
  std::string out;
  std::vector<std::string> set;
  bool quick = false;
  bool keep = false;
  bool any_build = false;
  bool list = false;
  bool report = false;
  std::string one_case;  ///< its name; empty: all
  unsigned jobs = std::max(1U, std::thread::hardware_concurrency());
};

/// Adds all options but the file's and the number of jobs.
void add_grid_options(CLI::App& command, GridOptions& options);

}  // namespace fleetmap::apps
