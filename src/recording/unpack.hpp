#pragma once

#include <cstddef>
#include <filesystem>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::recording {

/// Whether bytes begin as a frame of Zstandard does.
bool is_zstd(ByteView bytes);
/// Unpack whole frames of Zstandard and of LZ4, and streams of bzip2. Errors for damaged or cut ones, and for
/// more than `max_bytes` of content.
Result<Bytes> unpack_zstd(ByteView packed, std::size_t max_bytes);
Result<Bytes> unpack_lz4(ByteView packed, std::size_t max_bytes);
Result<Bytes> unpack_bz2(ByteView packed, std::size_t max_bytes);
/// A file compressed as a whole into another, which is replaced. Errors name the file that is at fault.
Status unpack_zstd_file(const std::filesystem::path& packed, const std::filesystem::path& into);

}  // namespace fleetmap::recording
