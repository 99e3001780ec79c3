#include "pack.hpp"

#include <lz4frame.h>
#include <zstd.h>

#include <string>

namespace fleetmap::recording {
namespace {

constexpr int kZstdLevel = 1;  // a scan is compressed in a few ms

}  // namespace

Result<Bytes> pack_zstd(ByteView bytes) {
  Bytes packed(ZSTD_compressBound(bytes.size()));
  const std::size_t size =
      ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), kZstdLevel);
  if (ZSTD_isError(size) != 0) return failure(std::string("zstd: ") + ZSTD_getErrorName(size));
  packed.resize(size);
  return packed;
}

Result<Bytes> pack_lz4(ByteView bytes) {
  Bytes packed(LZ4F_compressFrameBound(bytes.size(), nullptr));
  const std::size_t size =
      LZ4F_compressFrame(packed.data(), packed.size(), bytes.data(), bytes.size(), nullptr);
  if (LZ4F_isError(size) != 0) return failure(std::string("lz4: ") + LZ4F_getErrorName(size));
  packed.resize(size);
  return packed;
}

}  // namespace fleetmap::recording
