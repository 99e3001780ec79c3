#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "fleetmap/core/result.hpp"

namespace fleetmap::experiment {

/// End of a child process.
struct ChildExit {
  int code = 0;  ///< exit code, or 128 + the signal that ended it
  bool signalled = false;
  double cpu_seconds = 0.0;
  double peak_megabytes = 0.0;  ///< largest resident set
};

/// Runs this very program, even if its file was replaced meanwhile, with `arguments` (without its name); its
/// output goes to `log`. Once `stop` is set the child is asked to end, two seconds later made to. It never
/// outlives this process.
///
/// By fork() and wait4(), because Boost.Process 1.74 reports neither CPU time nor memory of a child that
/// ended, and ties no child to its parent's life: what remained of run() would be its call of execv().
Result<ChildExit> run_self(const std::vector<std::string>& arguments, const std::filesystem::path& log,
                           const std::atomic<bool>& stop);
/// The same of another program or script; once asked to end it has as long as it takes it to clean up.
Result<ChildExit> run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                              const std::filesystem::path& log, const std::atomic<bool>& stop);
/// Fails, with the last words of its log, where a child crashed or called itself failed.
Status check_exit(const Result<ChildExit>& ended, const std::string& what, const std::filesystem::path& log);

/// The last lines of a log, for a message.
std::string tail_of(const std::filesystem::path& log, std::size_t lines);

}  // namespace fleetmap::experiment
