#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "experiment/case_record.hpp"

namespace fleetmap::apps::experiment {

struct RunnerConfig {
  std::filesystem::path directory;  ///< cases/<name>/ and their results are kept here
  unsigned jobs = 1;                ///< cases at a time
  bool keep = false;                ///< leave stores, maps and recordings where they are
  std::string program;              ///< the build that runs the cases
  bool any_program = false;         ///< take what another build finished, too
};

/// Where the experiment stands, told whenever a case begins or ends.
struct Progress {
  std::size_t total = 0;
  std::size_t finished = 0;  ///< failed ones and those of earlier starts too
  std::size_t failed = 0;
  std::size_t reused = 0;
  std::vector<std::string> running;
  double seconds_left = -1.0;         ///< estimated; negative: not known yet
  const CaseRecord* ended = nullptr;  ///< the case that just ended
};

struct Outcome {
  std::vector<CaseRecord> records;  ///< of finished and failed cases, in the order of the cases
  std::size_t total = 0;
  bool interrupted = false;
};

/// Runs what no earlier start has finished. A case that fails does not stop the others; it is run again by
/// the next start. Once `stop` is set no case is begun, and cases under way that then fail count as not run.
/// Fails when another start is at work in the directory, or nothing can be written there.
Result<Outcome> run_cases(const std::vector<Case>& cases, const Engine& engine, const RunnerConfig& config,
                          const std::atomic<bool>& stop,
                          const std::function<void(const Progress&)>& on_progress);

}  // namespace fleetmap::apps::experiment
