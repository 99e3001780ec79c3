#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "fleetmap/experiment/case_record.hpp"
#include "fleetmap/experiment/runner_config.hpp"

namespace fleetmap::experiment {

/// Progress of the experiment, reported whenever a case begins or ends.
struct Progress {
  std::size_t total = 0;
  std::size_t finished = 0;  ///< failed ones and those of earlier starts too
  std::size_t failed = 0;
  std::size_t reused = 0;
  std::vector<std::string> running;
  double seconds_left = -1.0;         ///< estimated; negative: not known yet
  const CaseRecord* ended = nullptr;  ///< the case that just ended
};

/// Records of the cases that were run, now or by an earlier start.
struct Outcome {
  std::vector<CaseRecord> records;   ///< of finished and failed cases, in the order of the cases
  std::size_t total = 0;             ///< cases
  std::vector<std::string> missing;  ///< names of the runs that are still to be made: one for equal cases

  bool complete() const { return missing.empty(); }
};

/// Runs what no earlier start has finished. A case that fails does not stop the others; it is run again by
/// the next start. Once `stop` is set no case is begun, and cases under way that then fail count as not run.
/// Fails when other processes run cases in the directory, or nothing can be written there.
Result<Outcome> run_cases(const std::vector<Case>& cases, const Engine& engine, const RunnerConfig& config,
                          const std::atomic<bool>& stop,
                          const std::function<void(const Progress&)>& on_progress);

/// Runs cases[index] alone, so that a cluster's scheduler distributes a grid: any number of processes on any
/// machines that share `config.directory`, one a case. Returns what there is already (`reused`) when the
/// case, or another one with equal inputs, is done. Fails when run_cases() is at work in the directory,
/// another process runs this very case, or `stop` interrupted it.
Result<CaseRecord> run_single_case(const std::vector<Case>& cases, std::size_t index, const Engine& engine,
                                   const RunnerConfig& config, const std::atomic<bool>& stop);

/// Reads the cases in the directory and runs none; safe while cases are being run.
Result<Outcome> collect_cases(const std::vector<Case>& cases, const RunnerConfig& config);

}  // namespace fleetmap::experiment
