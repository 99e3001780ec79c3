#pragma once

#include <filesystem>
#include <optional>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/loop_closure/registration_record.hpp"
#include "fleetmap/store/registration_log.hpp"

namespace fleetmap::agent {

/// Keeps what became of each registration: a line in registrations.csv, and both clouds in registrations.db,
/// so that the pair can be registered again by another method.
class RegistrationRecorder {
 public:
  /// Goes on with the files in `directory`. Clouds are not kept where their file cannot be opened or written.
  RegistrationRecorder(const AgentId& self, const std::filesystem::path& directory,
                       const store::RegistrationLogConfig& config = {});
  /// A registration has ended.
  void add(const loop_closure::Registration& registration);

 private:
  void add_row(const loop_closure::Registration& registration);
  void keep_input(const store::LoggedRegistration& input);

  AgentId self_;
  std::filesystem::path directory_;
  std::optional<store::RegistrationLog> log_;  ///< empty once it could not be written
};

}  // namespace fleetmap::agent
