#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fleetmap::apps {

/// State of a robot's computer on which a mission depends.
struct MachineState {
  std::optional<std::uint64_t> receive_buffer;  ///< net.core.rmem_max, bytes
  std::optional<std::uint64_t> free_bytes;      ///< where the store lies
  std::filesystem::path directory;              ///< of the store
};

/// `directory` need not exist yet.
MachineState machine_state(const std::filesystem::path& directory);
/// Findings that would spoil a mission, each with its remedy.
std::vector<std::string> machine_findings(const MachineState& state);

}  // namespace fleetmap::apps
