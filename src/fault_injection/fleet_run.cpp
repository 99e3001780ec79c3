#include "fleetmap/fault_injection/fleet_run.hpp"

#include <stdlib.h>

#include <cstdio>
#include <filesystem>

#include "faulty_fleet.hpp"

namespace fleetmap::fault_injection {
namespace {

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

Outcome run(const Scenario& scenario, const RunConfig& config) {
  if (!config.stores.empty()) return FaultyFleet(scenario, config, config.stores).run();
  const ScratchFolder folder;
  return FaultyFleet(scenario, config, folder.path()).run();
}

}  // namespace fleetmap::fault_injection
