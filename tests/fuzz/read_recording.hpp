#pragma once

#include <filesystem>

#include "checks.hpp"
#include "fleetmap/recording/reader.hpp"

namespace fleetmap::fuzz {

/// Opens a recording and reads all of it.
inline void read_recording(const std::filesystem::path& path) {
  const auto reader = recording::open(path);
  if (!reader) return require(!reader.error().message.empty(), "refused without a reason");
  while (true) {
    const auto sample = (*reader)->next();
    if (!sample) return require(!sample.error().message.empty(), "ends without a reason");
    if (!*sample) return;
    const auto* scan = std::get_if<sensor::Scan>(&**sample);
    for (std::size_t k = 0; scan != nullptr && k < scan->points.size(); ++k)
      require(scan->points[k].position.allFinite(), "a point that is not finite is left in a scan");
  }
}

}  // namespace fleetmap::fuzz
