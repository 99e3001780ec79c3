#pragma once

#include <atomic>
#include <filesystem>
#include <string>

#include "fleetmap/experiment/case_record.hpp"
#include "fleetmap/experiment/runner_config.hpp"

namespace fleetmap::experiment {

/// Result of an earlier start of the case: done or failed. Empty when it did not end, had other inputs than
/// those of `hash`, or was run by a build that `config` does not take.
std::optional<CaseRecord> recorded(const RunnerConfig& config, const Case& one, const std::string& hash,
                                   LostPictures pictures = LostPictures::kRunAgain);

/// Runs the case in its emptied folder and writes result.json there, last and whole; no other file of
/// `config.directory` is touched. A case that fails after `stop` was set was interrupted: it leaves no
/// result.json.
CaseRecord run_in_folder(const RunnerConfig& config, const Case& one, const std::string& hash,
                         const Engine& engine, const std::atomic<bool>& stop);

}  // namespace fleetmap::experiment
