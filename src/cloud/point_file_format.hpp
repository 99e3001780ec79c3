#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "fleetmap/core/result.hpp"

namespace fleetmap::cloud {

enum class PointFileFormat { ply, pcd };

/// By the extension, in any case. The error does not name the file.
Result<PointFileFormat> format_of(const std::filesystem::path& file);

/// Header of a binary file of float32 x y z, and intensity. `comments` are lines. A comment pads it, so that
/// its length does not depend on `points`: a stream writes it again once the points are counted.
std::string header_of(PointFileFormat format, std::size_t points, bool with_intensities,
                      std::span<const std::string> comments);

}  // namespace fleetmap::cloud
