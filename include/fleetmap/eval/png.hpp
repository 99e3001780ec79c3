#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/eval/image.hpp"

namespace fleetmap::eval {

Result<std::vector<std::uint8_t>> encode_png(const Image& image);
Status write_png(const std::filesystem::path& file, const Image& image);

}  // namespace fleetmap::eval
