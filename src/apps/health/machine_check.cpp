#include "machine_check.hpp"

#include <fstream>

#include "fleetmap/core/paths.hpp"
#include "fleetmap/core/receive_buffer.hpp"

namespace fleetmap::apps {
namespace {

constexpr std::uint64_t kMinReceiveBuffer = 4'000'000;  // a scan of 3 MB comes in one burst
constexpr std::uint64_t kFreeBytes = 2'000'000'000;     // a day of a fleet: 20,000 submaps of 80 kB

/// The folder itself or the nearest one above it that exists.
std::filesystem::path existing(std::filesystem::path folder) {
  std::error_code error;
  folder = std::filesystem::absolute(folder, error);
  while (!is_there(folder) && folder.has_relative_path()) folder = folder.parent_path();
  return folder;
}

}  // namespace

MachineState machine_state(const std::filesystem::path& directory) {
  MachineState state;
  state.directory = directory;
  std::uint64_t bytes = 0;
  if (std::ifstream("/proc/sys/net/core/rmem_max") >> bytes) state.receive_buffer = bytes;
  std::error_code error;
  const auto space = std::filesystem::space(existing(directory), error);
  if (!error) state.free_bytes = space.available;
  return state;
}

std::vector<std::string> machine_findings(const MachineState& state) {
  std::vector<std::string> findings;
  if (state.receive_buffer && *state.receive_buffer < kMinReceiveBuffer) {
    findings.push_back("net.core.rmem_max is " + std::to_string(*state.receive_buffer) +
                       " bytes, and large scans that come over UDP lose packets: " + kRaiseReceiveBuffer);
  }
  if (state.free_bytes && *state.free_bytes < kFreeBytes) {
    findings.push_back(state.directory.string() + ": " + std::to_string(*state.free_bytes / 1'000'000) +
                       " MB are free, and a day of a fleet's maps takes 2 GB: make room, or set `directory`");
  }
  return findings;
}

}  // namespace fleetmap::apps
