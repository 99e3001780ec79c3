#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::output {

/// One registration of two clouds, as a line of registrations.csv.
struct RegistrationRow {
  struct Fit {
    double rmse = 0.0;             ///< m, E_ij
    double inlier_fraction = 0.0;  ///< [0, 1]
    double overlap = 0.0;          ///< [0, 1]
  };
  NodeId target;
  NodeId source;
  std::string verdict;     ///< "failed" where there is no fit
  std::optional<Fit> fit;  ///< none: it failed
  double cpu_seconds = 0.0;
  std::string reason;  ///< of the verdict or of the failure
};

/// Begins the file if it is not there.
Status append_registration(const std::filesystem::path& file, const RegistrationRow& row);

}  // namespace fleetmap::output
