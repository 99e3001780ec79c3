#pragma once

#include <atomic>
#include <nlohmann/json_fwd.hpp>

#include "fleetmap/experiment/case.hpp"

namespace fleetmap::experiment {

/// Runs a case as two child processes, `fleetmap run` and `fleetmap eval`, and gathers what they wrote. A
/// crash fails this case alone, and its memory is given back.
class ChildEngine {
 public:
  /// `threads` is how many each child may keep busy.
  ChildEngine(const std::atomic<bool>& stop, unsigned threads) : stop_(&stop), threads_(threads) {}
  Result<CaseResult> operator()(const Case& one, const std::filesystem::path& directory) const;

 private:
  const std::atomic<bool>* stop_;
  unsigned threads_;
};

/// A file that a child has written. Fails with its name.
Result<nlohmann::json> read_json(const std::filesystem::path& file);

/// Merges a run's report.json and evaluation.json into one flat set: numbers by their dotted path
/// ("map.rmse", "map.f1[0]"; the whole evaluation, and those parts of the report that experiments compare),
/// lists named "histogram" with the "bin" beside them, pictures by kind.
CaseResult gather(const nlohmann::json& report, const nlohmann::json& evaluation);

}  // namespace fleetmap::experiment
