#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "fleetmap/experiment/case.hpp"

namespace fleetmap::experiment {

/// End of a case: `result` unless it failed, then `reason`.
struct CaseRecord {
  Case of;
  std::string folder;   ///< below cases/; that of another case if both have the same inputs
  std::string hash;     ///< of its inputs
  std::string program;  ///< the build that ran it
  double wall_seconds = 0.0;
  std::optional<CaseResult> result;
  std::string reason;
  bool reused = false;  ///< finished by an earlier start of the experiment

  bool done() const { return result.has_value(); }
};

/// The entry of a case in result.json and results.json.
nlohmann::json to_json(const CaseRecord& record);

/// Writes `directory`/result.json so that it is there whole or not at all.
Status write_record(const std::filesystem::path& directory, const CaseRecord& record);
/// Whether a case whose pictures were lost counts: its numbers are whole.
enum class LostPictures : std::uint8_t { kRunAgain, kLeftOut };
/// Record of an earlier start of the case, done or failed; empty if it did not come to its end, had other
/// inputs, lost its pictures (unless they are left out) or was run by another build than `program` (empty:
/// any will do).
std::optional<CaseRecord> read_record(const std::filesystem::path& directory, const Case& one,
                                      const std::string& hash, const std::string& program,
                                      LostPictures pictures = LostPictures::kRunAgain);

}  // namespace fleetmap::experiment
