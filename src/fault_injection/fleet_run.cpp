#include "fleetmap/fault_injection/fleet_run.hpp"

#include <stdlib.h>

#include <array>
#include <cstdio>
#include <filesystem>

#include "faulty_fleet.hpp"
#include "names.hpp"

namespace fleetmap::fault_injection {
namespace {

constexpr std::array<const char*, kInvariants> kNames{"converges",    "completes", "same_map",
                                                      "nothing_lost", "budget",    "bounded",
                                                      "alive",        "own_items", "starts"};

/// A folder of its own that goes with the object.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "fleetmap_fuzz_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::filesystem::filesystem_error(name, std::error_code());
    path_ = name;
  }
  ~ScratchFolder() { std::filesystem::remove_all(path_); }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace

const char* to_string(Invariant invariant) { return kNames.at(static_cast<std::size_t>(invariant)); }

Result<std::set<Invariant>> parse_invariants(std::string_view names) {
  return parse_names<Invariant>(names, kNames);
}

std::string to_string(const Violation& violation) {
  char at[32];
  std::snprintf(at, sizeof at, "%.2f s", to_seconds(violation.at));
  return std::string(to_string(violation.invariant)) + " at " + at + ", " +
         (violation.robot.empty() ? "fleet" : violation.robot) + ": " + violation.what;
}

Outcome run(const Scenario& scenario, const RunConfig& config) {
  const ScratchFolder folder;
  return FaultyFleet(scenario, config, folder.path()).run();
}

}  // namespace fleetmap::fault_injection
