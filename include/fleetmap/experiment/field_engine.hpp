#pragma once

#include <atomic>
#include <filesystem>
#include <mutex>

#include "fleetmap/config/field_config.hpp"
#include "fleetmap/experiment/case.hpp"

namespace fleetmap::experiment {

/// Runs a case with agents as processes in network namespaces (deploy/netns/field.sh --scenario trial), and
/// gathers what they left: field_measures(), and the evaluation against the truth where there is one.
class FieldEngine {
 public:
  /// Recordings that the fleet's file does not name are made once for each number of robots, below
  /// `directory`.
  FieldEngine(std::filesystem::path script, std::filesystem::path directory, const std::atomic<bool>& stop)
      : script_(std::move(script)), directory_(std::move(directory)), stop_(&stop) {}
  Result<CaseResult> operator()(const Case& one, const std::filesystem::path& directory) const;

 private:
  struct Recordings {
    std::filesystem::path bags;   ///< holds r1, r2, ...
    std::filesystem::path truth;  ///< holds NAME/truth.tum; empty: not known
  };
  Result<Recordings> recordings_of(const Case& one, const config::FieldConfig& field) const;
  Status run_field(const Case& one, const config::FieldConfig& field, const Recordings& recordings,
                   const std::filesystem::path& directory) const;

  std::filesystem::path script_, directory_;
  const std::atomic<bool>* stop_;
};

}  // namespace fleetmap::experiment
