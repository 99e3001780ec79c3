#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "point_levels.hpp"

namespace fleetmap::monitor {

/// First points of submaps, by the content hash of the submap in hexadecimal.
using Previews = std::map<std::string, std::shared_ptr<const QuantisedCloud>>;

/// Bytes of a file of previews: "FMPREV1", the content hash of what follows, then of each submap its hash and
/// its points as encoded_points() has them. Submaps never change under their hash, so a file is never out of
/// date; at most it lacks submaps or has some that are gone.
Bytes encoded_previews(const Previews& previews);
inline constexpr std::size_t kPreviewHeaderBytes = 24;
/// None where the bytes are damaged, or are of another version of the program. Then they are made again.
Previews decoded_previews(ByteView bytes);

/// None where there is no such file, it cannot be read, or it is damaged.
Previews read_previews(const std::filesystem::path& file);
/// The file appears whole or not at all.
Status write_previews(const std::filesystem::path& file, const Previews& previews);

}  // namespace fleetmap::monitor
