#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::output {

/// One registration of two clouds, as a line of registrations.csv.
struct RegistrationRow {
  NodeId target;
  NodeId source;
  std::string verdict;         ///< accepted, ambiguous, rejected, or failed where there is no result
  std::optional<double> rmse;  ///< m, E_ij; empty if it failed
  std::optional<double> inlier_fraction;  ///< [0, 1]
  std::optional<double> overlap;          ///< [0, 1]
  double cpu_seconds = 0.0;
  std::string reason;                        ///< of the verdict or of the failure
  std::optional<Pose> T_target_source = {};  ///< of the best mode, also where it was rejected
  std::optional<Stamp> done = {};            ///< by the robot's clock; ms
};

/// Name of the file in a robot's folder.
inline constexpr const char* kRegistrationsFile = "registrations.csv";

/// Writes the head of a file that is not there, which then shows that nothing was registered yet.
Status begin_registrations(const std::filesystem::path& file);
/// Begins the file if it is not there. A file that was begun without poses or times goes on without.
Status append_registration(const std::filesystem::path& file, const RegistrationRow& row);

/// Content of a registrations.csv.
struct Registrations {
  std::vector<RegistrationRow> rows;
  std::size_t damaged = 0;  ///< lines that cannot be read; they are left out
};
/// Finds the columns by the names in the first line, so that files with more, fewer or reordered columns can
/// be read; target, source and verdict must be there. Numbers that are missing or not finite stay empty.
Registrations parse_registrations(std::string_view csv);
/// With those of part_before(file). A file that is not there holds nothing.
Registrations read_registrations(const std::filesystem::path& file);

}  // namespace fleetmap::output
