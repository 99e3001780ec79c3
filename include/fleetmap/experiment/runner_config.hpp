#pragma once

#include <filesystem>
#include <string>

namespace fleetmap::experiment {

/// Folder, processes and program of a grid of runs.
struct RunnerConfig {
  std::filesystem::path directory;  ///< cases/<name>/ and their results are kept here
  unsigned jobs = 1;                ///< cases at a time
  bool keep = false;                ///< leave stores, maps and recordings where they are
  std::string program;              ///< the build that runs the cases
  bool any_program = false;         ///< take what another build finished, too

  std::filesystem::path folder(const std::string& name) const { return directory / "cases" / name; }
};

}  // namespace fleetmap::experiment
