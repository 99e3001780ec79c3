#pragma once

#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <optional>

#include "alignment_certainty.hpp"
#include "fleetmap/change/find_changes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/geodesy.hpp"

namespace fleetmap::apps {

/// Changes of a site between two days.
struct DayChanges {
  change::Changes changes;
  std::size_t alignments = 0;      ///< between the two days, that place them
  std::optional<GeoPoint> origin;  ///< of ENU, if the maps lie on Earth
  bool above_sea_level = false;    ///< heights of a day, as GPS gave them
  AlignmentCertainty certainty{};  ///< of these alignments
};

/// Aligns the stores of two days and compares their maps. Fails for days that cannot be aligned, or that
/// share an odometry session.
Result<DayChanges> changes_between(const std::filesystem::path& first, const std::filesystem::path& second);

/// Prints how well the two days can be compared, and a table of the changes.
void print_changes(std::ostream& out, const DayChanges& compared);

}  // namespace fleetmap::apps
